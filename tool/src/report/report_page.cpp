#include "report_page.h"
#include "softcell/base/assert.h"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace softcell::tool {
namespace {

/// The text with its markers ("@data@") replaced, from first to last. The inserted text is not searched for markers.
std::string fill_in(std::string_view text,
                    std::initializer_list<std::pair<std::string_view, std::string_view>> values) {
  std::string result;
  for (const auto& [marker, value] : values) {
    SC_ASSERT(marker.size() > 2 && marker.starts_with('@') && marker.ends_with('@'),
              "'{}' is no marker; it must look like @NAME@", marker);
    const std::size_t at = text.find(marker);
    if (at == std::string_view::npos) throw std::logic_error("report/page.html lacks " + std::string(marker));
    result.append(text.substr(0, at)).append(value);
    text.remove_prefix(at + marker.size());
  }
  return result.append(text);
}

std::string_view page_file(std::string_view name) {
  const base::EmbeddedFile* const file = base::find_embedded(embedded_report(), name);
  if (file == nullptr) throw std::logic_error("the build has left out report/" + std::string(name));
  return file->text;
}

std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// JSON that is safe in a script element: without "<", nothing in it can end the element or begin a comment.
std::string embeddable(const nlohmann::ordered_json& data) {
  const std::string json = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string result;
  result.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

std::string report_page(const TraceFile& trace, std::string_view title) {
  std::string script;
  for (const base::EmbeddedFile& file : embedded_report()) {
    if (file.name.ends_with(".js")) script.append(file.text).append("\n");
  }
  const std::string safe_title = escape_html(title), data = embeddable(report_data(trace));
  return fill_in(page_file("page.html"), {{"@title@", safe_title},
                                          {"@style@", page_file("style.css")},
                                          {"@name@", safe_title},
                                          {"@data@", data},
                                          {"@script@", script}});
}

}  // namespace softcell::tool
