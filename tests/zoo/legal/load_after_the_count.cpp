// keeps: load-in-flight
// Polls until the tag status can be read, by the channel's count and by the event: the bytes are there before it is read.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[32];

int main(uint64_t, uint64_t, uint64_t envp) {
  uint32_t sum = 0;
  mfc_write_tag_mask(1u << 3);
  mfc_get(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_update_all();
  while (mfc_stat_tag_status() == 0) {
  }
  sum += buffer[0];
  mfc_read_tag_status();
  spu_write_event_ack(MFC_TAG_STATUS_UPDATE_EVENT);
  spu_write_event_mask(MFC_TAG_STATUS_UPDATE_EVENT);
  mfc_get(buffer, envp, sizeof buffer, 3, 0, 0);
  mfc_write_tag_update_all();
  spu_read_event_status();
  sum += buffer[0];
  spu_write_event_ack(MFC_TAG_STATUS_UPDATE_EVENT);
  mfc_read_tag_status();
  buffer[1] = sum;
  return 0;
}
