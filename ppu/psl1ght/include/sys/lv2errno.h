#ifndef SOFTCELL_PSL1GHT_SYS_LV2ERRNO_H
#define SOFTCELL_PSL1GHT_SYS_LV2ERRNO_H
/* Errors of lv2 as errors of C. [PSL1GHT, sys/lv2errno.h] documented */

#include <errno.h>
#include <ppu-types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of errno.h for an error of lv2; a result that is no error stays as it is. */
s32 lv2error(s32 error);
/* Sets errno likewise. Returns -1 for an error, else the result. */
s32 lv2errno(s32 error);

#ifdef __cplusplus
}
#endif

#endif
