#pragma once
// A fault: the rule that a kernel broke, the place, what was found and what is allowed.

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// The rules; rules.def has one row for each. ls_sim reports the rules of the SPE by the same type.
enum class Rule {
#define SC_RULE(enumerator, name, evidence, explanation) enumerator,
#include "softcell/dma/rules.def"
#undef SC_RULE
};

inline constexpr Rule kAllRules[] = {
#define SC_RULE(enumerator, name, evidence, explanation) Rule::enumerator,
#include "softcell/dma/rules.def"
#undef SC_RULE
};

/// What a real Cell does when a rule is broken.
enum class Evidence {
  kRaised,       ///< it raises an error; documented
  kSilent,       ///< it raises nothing: the data are wrong, or the SPU waits for ever
  kUnconfirmed,  ///< we have no source; the explanation says so too
};

/// The rule's name for messages, tests and documents: "ea-alignment". Names do not change between versions.
std::string_view name(Rule rule);

/// One sentence: what is allowed, and what the hardware does with anything else.
std::string_view explanation(Rule rule);

Evidence evidence(Rule rule);

/// A rule that a kernel broke. The MFC knows neither the SPE's number nor the kernel nor the source line: the
/// SPE fills them in.
struct Fault {
  Rule rule{};
  int spe = -1;                            ///< -1: unknown
  std::string kernel = {};                 ///< empty: unknown
  std::string place = {};                  ///< source file and line, "saxpy.cpp:41"; empty: unknown
  std::optional<MfcCommand> command = {};  ///< set when a DMA command broke the rule
  std::string detail = {};                 ///< what was found and what is allowed; no full stop
  bool is_of_proxy = false;                ///< of a proxy command, which the PPU side issues, not a kernel

  /// All of it in one line: "SPE 2, kernel skin, skin.cpp:41: ea-alignment: getf tag 3, LSA 0x00400, EA
  /// 0x5EA010000008, 16 bytes: EA is ..."
  std::string message() const;
};

/// Thrown when bytes are to be moved: the host program has unmapped them since the command was issued.
class StorageLost : public std::runtime_error {
 public:
  explicit StorageLost(Fault what) : std::runtime_error(what.detail), fault(std::move(what)) {}
  Fault fault;
};

}  // namespace softcell::dma
