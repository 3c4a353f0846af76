#pragma once
// Cuts pairs of bodies into parts if they do not fit into a local store together, or touch at more points than the kernel contact_find has
// room for.
//
//     body a  [ ] [ ] [#] [#] [ ]      cells of a that are near b, some at a time, with their points;
//     body b      [#] [#] [#] [ ]      and cells of b that are near these, without points. Then the other way round.
//
// Both parts are written as small bodies, and the kernel takes them for whole ones. Each point is in one part only. The kernel also needs
// cells through which a way out of the body leads: the part of a has the inner cells of its cells with points, the part of b has all other
// cells, if they fit. These cells have no boxes, so they are near nothing.

#include <cstdint>
#include <span>
#include <vector>

#include "contact_find_job.h"
#include "contact_solve_job.h"
#include "softcell/dma/buffer.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more parts than ever before.
class FindParts {
 public:
  /// `memory` must outlive this object.
  explicit FindParts(dma::AddressSpace& memory) : memory_(memory) {}

  /// A body's arrays in main memory; they must stay in place until write().
  struct Body {
    std::span<const spu::FindCell> cells;
    std::span<const spu::FindGroup> groups;
    const spu::FindBoxes* boxes = nullptr;  ///< of four cells each
    std::span<const spu::FindEnd> ends;
    std::span<const spu::FindBegin> begins;
  };

  /// Forgets all parts.
  void clear();

  /// Cuts two bodies into parts and appends these.
  /// @param common  metres: the intersection of the bodies' boxes
  /// @return  false: even a single cell is near too many others; then nothing is appended
  bool add(const Body& a, const Body& b, const Bounds<3>& common);

  std::size_t size() const { return parts_.size(); }

  /// Writes all parts to main memory.
  /// @throws std::runtime_error  it is full.
  void write();
  /// Sets where a part's cells, groups and particles lie, and how many there are. @pre write() was called
  void describe(std::size_t part, spu::FindBody& a, spu::FindBody& b) const;
  /// Replaces the numbers of cells and particles in a contact of a part by those in the whole bodies.
  void restore(std::size_t part, spu::SolveContact& contact) const;

 private:
  /// Some cells of a body, and the particles at their corners.
  struct Selection {
    Body body;
    bool with_points = false;
    std::size_t first_cell = 0, cell_count = 0;          // in cells_
    std::size_t near_count = 0;                          // the first ones of these cells, which have boxes
    std::size_t first_particle = 0, particle_count = 0;  // in particles_
    std::size_t group_count = 0;
    std::size_t cells_at = 0, groups_at = 0, state_at = 0;  // in main memory
  };
  struct Part {
    Selection a, b;
  };

  bool add_points_of(const Body& mine, const Body& other, bool mine_is_a, const Bounds<3>& common);
  /// Selects cells with their points, and their inner cells.
  Selection select_points(const Body& body, std::span<const std::uint16_t> cells);
  /// Selects cells without points.
  Selection select_near(const Body& body, std::span<const std::uint16_t> cells);
  /// The first step of both, without inner cells and particles.
  Selection select_cells(const Body& body, std::span<const std::uint16_t> cells);
  /// Selects the particles of the selection's cells. @pre it is the last selection
  void select_particles(Selection& selection);
  /// Adds all other cells of the body, without particles, if the selection then has at most so many bytes. @pre it is the last selection
  void add_rest(Selection& selection, std::size_t most_bytes);
  std::span<const std::uint16_t> cells_of(const Selection& selection) const;
  /// Sets cell_number_ to the numbers of cells in a selection.
  void mark_cells(const Selection& selection);
  void write(const Selection& selection);
  static void set_counts(const Selection& selection, spu::FindBody& body);
  static std::uint32_t bytes_of_state(const Selection& selection);
  static std::uint32_t bytes_of(const Selection& selection);
  void describe(const Selection& selection, spu::FindBody& body) const;

  dma::AddressSpace& memory_;
  std::vector<Part> parts_;
  std::vector<std::uint16_t> cells_, particles_;  // of all selections: numbers in the bodies
  std::vector<std::uint16_t> mine_, near_;        // used by add()
  std::vector<std::uint16_t> number_;             // of each particle: its number in a selection, or kNone
  std::vector<std::uint16_t> cell_number_;        // of each cell likewise, or kFindNoCell
  dma::Buffer<spu::FindCell> part_cells_;
  dma::Buffer<spu::FindGroup> part_groups_;
  dma::Buffer<spu::FindEnd> part_state_;
};

}  // namespace softcell::ppu
