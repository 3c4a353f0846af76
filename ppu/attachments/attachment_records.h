#pragma once
// Converts AttachmentRows to records of the kernel `attach`, and back. In two dimensions a particle is a column of two, each of half its
// mass, as for contacts (flat_layer.h).

#include <span>

#include "attach_job.h"
#include "ppu/attachments/attach_unit.h"
#include "ppu/attachments/attachment_rows.h"

namespace softcell::ppu {

/// Used between begin() of its rows and the next begin(), instead of iterate() and finish().
template <int kDimension>
class AttachmentRecords {
 public:
  explicit AttachmentRecords(AttachmentRows<kDimension>& rows) : rows_(rows) {}

  /// Appends the records that the kernel needs. The caller sets AttachLink::rigid and assigns slots. @param once  as AttachLink::once
  /// @return false: the kernel cannot solve it, and nothing is appended.
  bool write(bool once, AttachUnit& unit) const;
  /// Reads back the kernel's results.
  void read(const spu::AttachLink& link, std::span<const spu::AttachPoint> points,
            std::span<const spu::AttachRow> rows);

 private:
  using Rows = AttachmentRows<kDimension>;
  void write_points(spu::AttachLink& link, AttachUnit& unit) const;
  void write_rows(spu::AttachLink& link, AttachUnit& unit) const;
  void write_entries(bool of_b, spu::AttachLink& link, AttachUnit& unit) const;

  Rows& rows_;
};

}  // namespace softcell::ppu
