#include "verb_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "exit_status.h"
#include "output_files.h"
#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

namespace fs = std::filesystem;

/// The path with its links followed as far as files exist; a link to a file that is still to be made is replaced by that file. Only the
/// rest is normalised, because `..` of a link is not the folder in which the link is.
fs::path one_spelling(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(base::WholeFile::behind_links(path), error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

bool is_device_or_pipe(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

bool is_one_file(const fs::path& a, const fs::path& b) {
  if (a == kStandardOutput || b == kStandardOutput) return a == b;
  if (is_device_or_pipe(a) || is_device_or_pipe(b)) return false;
  return one_spelling(a) == one_spelling(b);
}

void check_distinct(const std::vector<NamedFile>& files) {
  for (auto one = files.begin(); one != files.end(); ++one) {
    SC_ASSERT(!one->name.empty(), "one of {} files has no name", files.size());
    const auto same = std::find_if(files.begin(), one, [&](const NamedFile& other) {
      return one->file && other.file && is_one_file(*one->file, *other.file);
    });
    if (same == one) continue;
    throw UsageError(fmt::format("{} and {} are one file, {}; give each a file of its own", same->name,
                                 one->name, one->file->string()));
  }
}

void check_kept(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written) {
  for (const NamedFile& input : read) {
    for (const NamedFile& output : written) check_distinct({input, output});
  }
}

std::string explanation_of(const std::exception& error) {
  const std::string text = error.what();
  const std::size_t prefix = text.starts_with("[json.exception.") ? text.find("] ") : std::string::npos;
  return prefix == std::string::npos ? text : text.substr(prefix + 2);
}

void write_json(base::WholeFile& file, const nlohmann::ordered_json& document) {
  SC_ASSERT(!document.is_null() && !document.is_discarded(),
            "the JSON document of {} values is null or discarded", document.size());
  // Names of files need not be UTF-8.
  file.write(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file.finish();
}

}  // namespace softcell::tool
