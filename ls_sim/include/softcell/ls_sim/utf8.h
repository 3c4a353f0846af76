#pragma once

#include <cstddef>
#include <string_view>

namespace softcell::ls_sim {

/// Bytes of the UTF-8 sequence at `at`, or 0 when there is none. [RFC 3629] @pre at < text.size()
std::size_t utf8_length(std::string_view text, std::size_t at);

}  // namespace softcell::ls_sim
