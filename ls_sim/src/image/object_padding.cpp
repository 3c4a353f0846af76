#include "object_padding.h"
#include "softcell/base/assert.h"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <libelf.h>

#include <algorithm>
#include <functional>

namespace softcell::ls_sim {
namespace {

constexpr int kDeepestNesting = 16;

/// Which bytes of one variable its members take.
class Coverage {
 public:
  Coverage(std::uint32_t lsa, std::uint32_t bytes) : lsa_(lsa), taken_(bytes, false) {
    SC_ASSERT(bytes <= dma::kLocalStoreBytes && lsa <= dma::kLocalStoreBytes - bytes,
              "a variable of {} bytes at {}", bytes, lsa);
  }

  void add_type(Dwarf_Die type, std::uint64_t offset, int depth = 0) {
    Dwarf_Die die;
    if (depth > kDeepestNesting || dwarf_peel_type(&type, &die) != 0) return;
    switch (dwarf_tag(&die)) {
      case DW_TAG_structure_type:
      case DW_TAG_class_type:
      case DW_TAG_union_type:
        add_members(die, offset, depth);
        return;
      case DW_TAG_array_type:
        add_elements(die, offset, depth);
        return;
      default:
        take(offset, size_of(die));
    }
  }

  void append_gaps(std::vector<PaddingRange>& gaps) const {
    for (std::size_t i = 0; i < taken_.size();) {
      std::size_t end = i;
      while (end < taken_.size() && !taken_[end]) ++end;
      if (end != i)
        gaps.push_back({lsa_ + static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - i)});
      i = std::max(end, i + 1);
    }
  }

 private:
  static std::uint64_t number(Dwarf_Die& die, unsigned int name) {
    Dwarf_Attribute attribute;
    Dwarf_Word value = 0;
    return dwarf_formudata(dwarf_attr(&die, name, &attribute), &value) == 0 ? value : 0;
  }
  static std::uint64_t size_of(Dwarf_Die& die) {
    Dwarf_Word bytes = 0;
    return dwarf_aggregate_size(&die, &bytes) == 0 ? bytes : 0;
  }

  void take(std::uint64_t offset, std::uint64_t bytes) {
    for (std::uint64_t i = offset; i < taken_.size() && i - offset < bytes; ++i) taken_[i] = true;
  }

  void add_members(Dwarf_Die& type, std::uint64_t offset, int depth) {
    Dwarf_Die member;
    for (int more = dwarf_child(&type, &member); more == 0; more = dwarf_siblingof(&member, &member)) {
      const int tag = dwarf_tag(&member);
      if ((tag != DW_TAG_member && tag != DW_TAG_inheritance) ||
          dwarf_hasattr(&member, DW_AT_declaration) != 0 || dwarf_hasattr(&member, DW_AT_external) != 0) {
        continue;  // functions, types, static members
      }
      Dwarf_Attribute attribute;
      Dwarf_Die member_type;
      if (const std::uint64_t bits = number(member, DW_AT_bit_size); bits != 0) {
        const std::uint64_t first = number(member, DW_AT_data_bit_offset);
        take(offset + first / 8, (first % 8 + bits + 7) / 8);
      } else if (dwarf_formref_die(dwarf_attr(&member, DW_AT_type, &attribute), &member_type) != nullptr) {
        add_type(member_type, offset + number(member, DW_AT_data_member_location), depth + 1);
      }
    }
  }

  void add_elements(Dwarf_Die& type, std::uint64_t offset, int depth) {
    Dwarf_Attribute attribute;
    Dwarf_Die declared, element;
    if (dwarf_formref_die(dwarf_attr(&type, DW_AT_type, &attribute), &declared) == nullptr ||
        dwarf_peel_type(&declared, &element) != 0) {
      return;
    }
    const std::uint64_t bytes = size_of(type), step = size_of(element);
    if (dwarf_tag(&element) == DW_TAG_base_type || step == 0) {
      take(offset, bytes);
    } else {
      for (std::uint64_t at = 0; at + step <= bytes && offset + at < taken_.size(); at += step)
        add_type(element, offset + at, depth + 1);
    }
  }

  std::uint32_t lsa_;
  std::vector<bool> taken_;
};

/// The fixed address of a variable; 0 when it has none.
std::uint64_t address_of(Dwarf_Die& variable) {
  Dwarf_Attribute location, address;
  Dwarf_Op* operations = nullptr;
  std::size_t count = 0;
  Dwarf_Addr value = 0;
  if (dwarf_getlocation(dwarf_attr_integrate(&variable, DW_AT_location, &location), &operations, &count) !=
          0 ||
      count != 1) {
    return 0;
  }
  if (operations->atom == DW_OP_addr) return operations->number;
  const bool is_indexed = operations->atom == DW_OP_addrx &&
                          dwarf_getlocation_attr(&location, operations, &address) == 0 &&
                          dwarf_formaddr(&address, &value) == 0;
  return is_indexed ? value : 0;
}

/// All variables below a scope, those of functions and namespaces too.
void for_each_variable(Dwarf_Die& scope, const std::function<void(Dwarf_Die&)>& body) {
  Dwarf_Die die;
  for (int more = dwarf_child(&scope, &die); more == 0; more = dwarf_siblingof(&die, &die)) {
    switch (dwarf_tag(&die)) {
      case DW_TAG_variable:
        body(die);
        break;
      case DW_TAG_namespace:
      case DW_TAG_subprogram:
      case DW_TAG_lexical_block:
        for_each_variable(die, body);
        break;
      default:
        break;
    }
  }
}

}  // namespace

std::vector<PaddingRange> padding_of(const KernelImage& image) {
  std::vector<PaddingRange> gaps;
  if (!image.elf) return gaps;
  elf_version(EV_CURRENT);
  // It is only read, although libelf's signature has no const.
  Elf* const elf =
      elf_memory(reinterpret_cast<char*>(const_cast<std::byte*>(image.elf->data())), image.elf->size());
  Dwarf* const dwarf = elf == nullptr ? nullptr : dwarf_begin_elf(elf, DWARF_C_READ, nullptr);
  const auto add = [&](Dwarf_Die& variable) {
    const std::uint64_t address = address_of(variable);
    const auto object = std::find_if(image.objects.begin(), image.objects.end(),
                                     [&](const ImageObject& o) { return o.begin.value == address; });
    Dwarf_Attribute attribute;
    Dwarf_Die type;
    if (object == image.objects.end() ||
        dwarf_formref_die(dwarf_attr_integrate(&variable, DW_AT_type, &attribute), &type) == nullptr) {
      return;
    }
    Coverage coverage(object->begin.value, object->bytes);
    coverage.add_type(type, 0);
    coverage.append_gaps(gaps);
  };
  Dwarf_CU* unit = nullptr;
  Dwarf_Die die;
  while (dwarf != nullptr && dwarf_get_units(dwarf, unit, &unit, nullptr, nullptr, &die, nullptr) == 0)
    for_each_variable(die, add);
  dwarf_end(dwarf);
  elf_end(elf);
  return gaps;
}

}  // namespace softcell::ls_sim
