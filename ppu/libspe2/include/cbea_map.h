#ifndef SOFTCELL_CBEA_MAP_H
#define SOFTCELL_CBEA_MAP_H
/* The problem-state areas of an SPE, as spe_ps_area_get() returns them. A register's offset in its area is that in
 * the Cell's memory map, less the area's own. [CBEA, problem state memory map] documented
 *
 * Registers are volatile also where the program's pointer is not: otherwise a compiler for the PC loads one byte for
 * `SPU_Mbox_Stat & 0xFF`, which no register answers, and a loop that waits for it loads it once. */
#if defined(__INCLUDE_LEVEL__) && __INCLUDE_LEVEL__ > 0
#pragma GCC system_header /* as on a Cell: no warnings of it, whatever standard the program asks for */
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* SPE_MSSYNC_AREA */
typedef struct spe_mssync_area {
  volatile unsigned int MFC_MSSync;
} spe_mssync_area_t;

/* SPE_MFC_COMMAND_AREA */
typedef struct spe_mfc_command_area {
  unsigned char reserved_0_3[4];
  volatile unsigned int MFC_LSA;
  volatile unsigned int MFC_EAH;
  volatile unsigned int MFC_EAL;
  volatile unsigned int MFC_Size_Tag;
  union {
    volatile unsigned int MFC_ClassID_CMD;
    volatile unsigned int MFC_CMDStatus;
  };
  unsigned char reserved_18_103[236];
  volatile unsigned int MFC_QStatus;
  unsigned char reserved_108_203[252];
  volatile unsigned int Prxy_QueryType;
  unsigned char reserved_208_21B[20];
  volatile unsigned int Prxy_QueryMask;
  unsigned char reserved_220_22B[12];
  volatile unsigned int Prxy_TagStatus;
} spe_mfc_command_area_t;

/* SPE_CONTROL_AREA */
typedef struct spe_spu_control_area {
  unsigned char reserved_0_3[4];
  volatile unsigned int SPU_Out_Mbox;
  unsigned char reserved_8_B[4];
  volatile unsigned int SPU_In_Mbox;
  unsigned char reserved_10_13[4];
  volatile unsigned int SPU_Mbox_Stat;
  unsigned char reserved_18_1B[4];
  volatile unsigned int SPU_RunCntl;
  unsigned char reserved_20_23[4];
  volatile unsigned int SPU_Status;
  unsigned char reserved_28_33[12];
  volatile unsigned int SPU_NPC;
} spe_spu_control_area_t;

/* SPE_SIG_NOTIFY_1_AREA */
typedef struct spe_sig_notify_1_area {
  unsigned char reserved_0_B[12];
  volatile unsigned int SPU_Sig_Notify_1;
} spe_sig_notify_1_area_t;

/* SPE_SIG_NOTIFY_2_AREA */
typedef struct spe_sig_notify_2_area {
  unsigned char reserved_0_B[12];
  volatile unsigned int SPU_Sig_Notify_2;
} spe_sig_notify_2_area_t;

#ifdef __cplusplus
}
#endif

#endif
