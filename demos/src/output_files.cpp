#include "output_files.h"

namespace softcell::demos {

ls_sim::WholeFile& OutputFiles::open(const std::filesystem::path& file) { return files_.emplace_back(file); }

ls_sim::WholeFile* OutputFiles::open(const std::optional<std::filesystem::path>& file) {
  return file ? &open(*file) : nullptr;
}

void OutputFiles::commit() {
  for (ls_sim::WholeFile& file : files_) file.finish();
  for (ls_sim::WholeFile& file : files_) file.commit();
}

}  // namespace softcell::demos
