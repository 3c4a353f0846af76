#pragma once
// How much bodies of one model are strained, as the kernel `strain` finds it on the SPEs.
//
//     StrainLooks<3> looks(memory, model, places, bodies);
//     if (const auto job = looks.job(number, body, positions_ea))   // of bodies that break, or that are about to look whether they yield
//       chain.add({strain, *job});
//     ...                                                           // the chain's jobs run
//     if (!looks.may_break(number)) ...                             // nobody has to look closer
//
// A look on an SPE is a hint on the safe side. What yields and what breaks is decided by the PPU, as without SPEs.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/soft_bodies/soft_body.h"
#include "strain_job.h"

namespace softcell::ppu {

/// Used by one thread at a time. While jobs are under way nothing may be asked.
/// @tparam kDimension  2 or 3
template <int kDimension>
class StrainLooks {
 public:
  using Body = SoftBody<kDimension>;
  using Model = SoftBodyModel<kDimension>;

  /// Whether it is worth a job, and fits a local store. @param places  of positions in main memory, those between particles included
  static bool can_look_at(const Model& model, std::size_t places);

  /// @param place_of  of each particle: where its position lies; empty: particle i is the i-th
  /// @pre can_look_at()   @throws std::runtime_error  main memory is full.
  StrainLooks(dma::AddressSpace& memory, std::shared_ptr<const Model> model,
              std::span<const std::uint32_t> place_of, std::size_t places, std::size_t bodies);

  /// The descriptor of a job that looks at a body, if there is something to look for: at the distances in a plastic body whose next flow()
  /// looks at them, which has a StrainLooks for itself and has had its rest shape at the look before; at the faces of another one that may
  /// break, if it has its model's rest shape.
  /// @param positions  where they lie   @throws std::runtime_error  main memory is full.
  std::optional<dma::EffectiveAddress> job(std::size_t number, const Body& body,
                                           dma::EffectiveAddress positions);

  /// Of the body's last job(). False: no face has broken.
  bool may_break(std::size_t number) const;
  /// Of the body's last job(): what SoftBody::flow() takes; nothing if distances were not looked at.
  std::optional<float> stretch(std::size_t number) const;

 private:
  void write_faces();
  bool has_lengths_of(const Body& body);
  void write_lengths(const Body& body);
  std::uint16_t place_of(std::uint32_t particle) const;

  dma::AddressSpace& memory_;
  std::shared_ptr<const Model> model_;
  std::vector<std::uint32_t> place_of_;  // none: particle i is the i-th
  std::uint32_t places_;
  dma::Buffer<spu::StrainJob> jobs_;
  dma::Buffer<spu::StrainResult> results_;
  // Empty until a body wants them.
  dma::Buffer<spu::StrainFaces> faces_;
  dma::Buffer<spu::StrainLengths> lengths_;
  bool has_faces_ = false;         // written; there may be none
  std::uint32_t edge_groups_ = 0;  // of `lengths_`; the others are of diagonals
  // SoftBody::rest_revision() of `lengths_`, and of the last look.
  std::optional<std::uint32_t> rest_of_lengths_, seen_rest_;
};

extern template class StrainLooks<2>;
extern template class StrainLooks<3>;

}  // namespace softcell::ppu
