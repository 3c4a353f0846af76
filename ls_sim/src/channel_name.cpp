#include "softcell/ls_sim/channel_name.h"

#include <array>

namespace softcell::ls_sim {
namespace {

constexpr std::array<std::string_view, 31> kNames{"SPU_RdEventStat",
                                                  "SPU_WrEventMask",
                                                  "SPU_WrEventAck",
                                                  "SPU_RdSigNotify1",
                                                  "SPU_RdSigNotify2",
                                                  "",
                                                  "",
                                                  "SPU_WrDec",
                                                  "SPU_RdDec",
                                                  "MFC_WrMSSyncReq",
                                                  "",
                                                  "SPU_RdEventMask",
                                                  "MFC_RdTagMask",
                                                  "SPU_RdMachStat",
                                                  "SPU_WrSRR0",
                                                  "SPU_RdSRR0",
                                                  "MFC_LSA",
                                                  "MFC_EAH",
                                                  "MFC_EAL",
                                                  "MFC_Size",
                                                  "MFC_TagID",
                                                  "MFC_Cmd",
                                                  "MFC_WrTagMask",
                                                  "MFC_WrTagUpdate",
                                                  "MFC_RdTagStat",
                                                  "MFC_RdListStallStat",
                                                  "MFC_WrListStallAck",
                                                  "MFC_RdAtomicStat",
                                                  "SPU_WrOutMbox",
                                                  "SPU_RdInMbox",
                                                  "SPU_WrOutIntrMbox"};

}  // namespace

std::string_view channel_name(std::uint32_t number) {
  return number < kNames.size() ? kNames[number] : std::string_view();
}

}  // namespace softcell::ls_sim
