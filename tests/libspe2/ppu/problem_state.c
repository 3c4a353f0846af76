/* Mailboxes, signals and proxy DMA by plain loads and stores of the problem state. */
#include <cbe_mfc.h>

#include "run_in_thread.h"

extern spe_program_handle_t echoes, collects_signals, sums_its_store, pauses;

static unsigned int words[256] __attribute__((aligned(128)));

/* As the SDK's samples do: by pointers to areas that are not volatile. */
static unsigned int receive(spe_spu_control_area_t* control) {
  while ((control->SPU_Mbox_Stat & 0xFF) == 0) {
  }
  return control->SPU_Out_Mbox;
}

static void send(spe_spu_control_area_t* control, unsigned int value) {
  while ((control->SPU_Mbox_Stat >> 8 & 0xFF) == 0) {
  }
  control->SPU_In_Mbox = value;
}

static void ping(void) {
  spe_thread_t spe;
  spe_spu_control_area_t* control;
  unsigned int i, doubled;
  start_spe(&spe, &echoes, SPE_MAP_PS, NULL, NULL);
  control = (spe_spu_control_area_t*)spe_ps_area_get(spe.context, SPE_CONTROL_AREA);
  CHECK(control != NULL);
  for (i = 1; i <= 20; ++i) {
    send(control, i);
    CHECK(receive(control) == i + 1);
    CHECK(spe_out_intr_mbox_read(spe.context, &doubled, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  }
  control->SPU_In_Mbox = 0;
  CHECK(end_spe(&spe) == 20);
}

static void signal_it(void) {
  spe_thread_t spe;
  unsigned int all = 1;
  volatile spe_sig_notify_1_area_t* first;
  volatile spe_sig_notify_2_area_t* second;
  start_spe(&spe, &collects_signals, SPE_MAP_PS | SPE_CFG_SIGNOTIFY1_OR, NULL, NULL);
  first = (volatile spe_sig_notify_1_area_t*)spe_ps_area_get(spe.context, SPE_SIG_NOTIFY_1_AREA);
  second = (volatile spe_sig_notify_2_area_t*)spe_ps_area_get(spe.context, SPE_SIG_NOTIFY_2_AREA);
  first->SPU_Sig_Notify_1 = 1;
  first->SPU_Sig_Notify_1 = 4;
  second->SPU_Sig_Notify_2 = 3;
  CHECK(spe_in_mbox_write(spe.context, &all, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  CHECK(end_spe(&spe) == (5 << 4 | 3));
}

static void transfer(void) {
  spe_thread_t spe;
  volatile spe_mfc_command_area_t* mfc;
  spe_spu_control_area_t* control;
  unsigned int i, expected = 0, place;
  start_spe(&spe, &sums_its_store, SPE_MAP_PS, NULL, NULL);
  mfc = (volatile spe_mfc_command_area_t*)spe_ps_area_get(spe.context, SPE_MFC_COMMAND_AREA);
  control = (spe_spu_control_area_t*)spe_ps_area_get(spe.context, SPE_CONTROL_AREA);
  place = receive(control);
  for (i = 0; i < 256; ++i) expected += words[i] = i * i;
  do {
    mfc->MFC_LSA = place;
    mfc->MFC_EAH = (unsigned int)((unsigned long long)(uintptr_t)words >> 32);
    mfc->MFC_EAL = (unsigned int)(uintptr_t)words;
    mfc->MFC_Size_Tag = (unsigned int)sizeof words << 16 | 7;
    mfc->MFC_ClassID_CMD = MFC_CMD_WORD(0, 0, MFC_GET_CMD);
  } while (mfc->MFC_CMDStatus != MFC_PPU_DMA_CMD_ENQUEUE_SUCCESSFUL);
  mfc->Prxy_QueryMask = 1u << 7;
  while (mfc->Prxy_TagStatus != 1u << 7) {
  }
  CHECK((mfc->MFC_QStatus & 0xF) == 8);
  send(control, 1);
  CHECK(receive(control) == expected);
  send(control, 0);
  CHECK(end_spe(&spe) == 0);
}

static void stop(void) {
  spe_context_ptr_t spe = spe_context_create(SPE_MAP_PS, NULL);
  unsigned int entry = SPE_DEFAULT_ENTRY;
  volatile spe_spu_control_area_t* control =
      (volatile spe_spu_control_area_t*)spe_ps_area_get(spe, SPE_CONTROL_AREA);
  unsigned int status = control->SPU_Status;
  CHECK(status == 0);
  CHECK(spe_program_load(spe, &pauses) == 0);
  CHECK(spe_context_run(spe, &entry, 0, NULL, (void*)7, NULL) == 0x11);
  status = control->SPU_Status;
  CHECK(status == (0x11 << 16 | 2));
  while (spe_context_run(spe, &entry, 0, NULL, NULL, NULL) > 0) {
  }
  status = control->SPU_Status;
  CHECK(status == (0x200Au << 16 | 2));
  CHECK(spe_context_destroy(spe) == 0);
}

int main(void) {
  ping();
  signal_it();
  transfer();
  stop();
  puts("ok");
  return 0;
}
