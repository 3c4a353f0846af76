#pragma once
// Finds the source line of an instruction of an image.

#include <memory>
#include <string>

#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// A line of a source file.
struct SourcePlace {
  std::string file;  ///< absolute, if the compiler has written where it ran; empty: not known
  int line = 0;
};

/// Reads the DWARF line table of an image. One thread at a time.
class SourceLines {
 public:
  /// For an image without debug information, every place is empty. Keeps the image's file alive, not the image.
  explicit SourceLines(const KernelImage& image);
  ~SourceLines();
  SourceLines(const SourceLines&) = delete;
  SourceLines& operator=(const SourceLines&) = delete;

  /// "saxpy.cpp:41": file name without its folder, and line. For code that was inlined from the headers of
  /// the SDK, the line that called them. Empty when not known.
  std::string place_of(dma::LocalStoreAddress instruction) const;

  /// The same with the whole name of the file.
  SourcePlace source_of(dma::LocalStoreAddress instruction) const;

  /// Whether the instruction belongs to the C library of the local store, which no user of the SDK has written.
  bool is_in_library(dma::LocalStoreAddress instruction) const;

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace softcell::ls_sim
