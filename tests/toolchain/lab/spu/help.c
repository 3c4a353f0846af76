#include "help.h"
#include <spu_mfcio.h>
#define TAG 2
void fetch(void *ls, unsigned long long ea, unsigned bytes) {
  mfc_get(ls, ea, bytes, TAG, 0, 0);
#ifndef FORGETS
  mfc_write_tag_mask(1 << TAG);
  mfc_read_tag_status_all();
#endif
}
void store(void *ls, unsigned long long ea, unsigned bytes) {
  mfc_put(ls, ea, bytes, TAG, 0, 0);
  mfc_write_tag_mask(1 << TAG);
  mfc_read_tag_status_all();
}
