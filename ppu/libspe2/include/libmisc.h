/* What programs commonly use of the Cell SDK's library misc, as inline functions: there is no -lmisc. [SDK for Multicore Acceleration,
 * example library] documented */
#ifndef SOFTCELL_LIBMISC_H
#define SOFTCELL_LIBMISC_H

#include <malloc_align.h>

#endif
