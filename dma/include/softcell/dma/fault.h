#pragma once
// A broken rule: which one, who broke it, and what was found instead of what is allowed.

#include <optional>
#include <string>
#include <string_view>

#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// The rules, one row each in rules.def. The SPE (ls_sim) reports its own through the same type.
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
  kSilent,       ///< it raises nothing: wrong data, or a wait without end
  kUnconfirmed,  ///< no source at hand says; the explanation says so too
};

/// Stable, in kebab case, for messages, tests and documents: "ea-alignment".
std::string_view name(Rule rule);

/// One sentence: what is allowed, and what the hardware does otherwise.
std::string_view explanation(Rule rule);

Evidence evidence(Rule rule);

/// A rule broken by a kernel. The MFC knows neither the SPE's number nor the kernel nor the place: the SPE
/// fills them in.
struct Fault {
  Rule rule{};
  int spe = -1;                            ///< -1: not known
  std::string kernel = {};                 ///< empty: not known
  std::string place = {};                  ///< source file and line, "saxpy.cpp:41"; empty: not known
  std::optional<MfcCommand> command = {};  ///< set when a DMA command broke the rule
  std::string detail = {};                 ///< what was found and what is allowed; no full stop

  /// One line with all of the above:
  /// "SPE 2, kernel skin, skin.cpp:41: ea-alignment: getf tag 3, LSA 0x00400, EA 0x5EA010000008, 16 bytes: EA
  /// is ..."
  std::string message() const;
};

}  // namespace softcell::dma
