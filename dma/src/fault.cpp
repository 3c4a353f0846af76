#include "softcell/dma/fault.h"

#include "softcell/base/assert.h"
#include "text.h"

namespace softcell::dma {
namespace {

struct RuleRow {
  std::string_view name;
  Evidence evidence;
  std::string_view explanation;
};

constexpr RuleRow kRules[] = {
#define SC_RULE(enumerator, name, evidence, explanation) {name, Evidence::evidence, explanation},
#include "softcell/dma/rules.def"
#undef SC_RULE
};

const RuleRow& row(Rule rule) {
  SC_ASSERT(static_cast<std::size_t>(rule) < std::size(kRules), "rule {} of {}", rule, std::size(kRules));
  return kRules[static_cast<std::size_t>(rule)];
}

/// Only what the command looks at: a getllar has no tag, a barrier no address.
std::string to_text(const MfcCommand& command) {
  const std::string_view known = name(command.opcode());
  const std::string text = known.empty() ? "command " + hex(command.word, 8) : std::string(known);
  const std::string tag = " tag " + std::to_string(command.tag);
  const std::string lsa = ", LSA " + to_text(command.lsa);
  const std::string ea = ", EA " + to_text(command.ea);
  const std::string bytes = ", " + byte_count(command.size);
  switch (command.kind()) {
    case CommandKind::kList:
      return text + tag + lsa + ", MFC_EAH " + hex(command.ea.value >> 32, 8) + ", list " +
             to_text(command.list_address()) + ", " + byte_count(command.size) + " of list";
    case CommandKind::kLine:
      return text + lsa + ea;
    case CommandKind::kQueuedLine:
      return text + tag + lsa + ea;
    case CommandKind::kOrdering:
      return text + tag;
    case CommandKind::kCacheHint:
      return text + tag + ea + bytes;
    default:
      return text + tag + lsa + ea + bytes;
  }
}

}  // namespace

std::string_view name(Rule rule) { return row(rule).name; }
std::string_view explanation(Rule rule) { return row(rule).explanation; }
Evidence evidence(Rule rule) { return row(rule).evidence; }

std::string Fault::message() const {
  std::string text = spe < 0 ? "SPE unknown" : "SPE " + std::to_string(spe);
  if (is_of_proxy) {
    text += ", proxy command of the PPU side";
  } else {
    text += ", kernel " + (kernel.empty() ? "unknown" : kernel);
  }
  if (!place.empty()) text += ", " + place;
  text += ": ";
  text += name(rule);
  if (command) text += ": " + to_text(*command);
  if (!detail.empty()) text += ": " + detail;
  return text;
}

}  // namespace softcell::dma
