#pragma once
// Measures on the SPEs, with the kernel `strain`, how much bodies of one model are strained.
//
//     StrainLooks<3> looks(memory, model, places, bodies);
//     if (const auto job = looks.job(number, body, positions_ea))   // for bodies that break, or will soon check for yielding
//       chain.add({strain, *job});
//     ...                                                           // the chain's jobs run
//     if (!looks.may_break(number)) ...                             // the PPU need not look closer
//
// The result of an SPE is a hint on the safe side. The PPU decides what yields and what breaks, as it does without SPEs.

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

/// Used by one thread at a time. While jobs are under way, call nothing.
/// @tparam kDimension  2 or 3
template <int kDimension>
class StrainLooks {
 public:
  using Body = SoftBody<kDimension>;
  using Model = SoftBodyModel<kDimension>;

  /// Whether a look is worth a job and fits a local store. @param places  number of positions in main memory, including gaps between
  /// particles
  static bool can_look_at(const Model& model, std::size_t places);

  /// @param place_of  for each particle: where its position lies; empty: particle i lies at i
  /// @pre can_look_at()   @throws std::runtime_error  main memory is full.
  StrainLooks(dma::AddressSpace& memory, std::shared_ptr<const Model> model,
              std::span<const std::uint32_t> place_of, std::size_t places, std::size_t bodies);

  /// The descriptor of a job that looks at a body, if there is anything to look for. It looks at distances if the next flow() of a plastic
  /// body looks at them, provided the body does not share this object with others and had the same rest shape at the look before. It looks
  /// at faces of other bodies that may break, provided they have the model's rest shape.
  /// @param positions  where they lie   @throws std::runtime_error  main memory is full.
  std::optional<dma::EffectiveAddress> job(std::size_t number, const Body& body,
                                           dma::EffectiveAddress positions);

  /// The result of the body's last job(). False: no face has broken.
  bool may_break(std::size_t number) const;
  /// The result of the body's last job(), for SoftBody::flow(); nothing if distances were not looked at.
  std::optional<float> stretch(std::size_t number) const;

 private:
  void write_faces();
  bool has_lengths_of(const Body& body);
  void write_lengths(const Body& body);
  std::uint16_t place_of(std::uint32_t particle) const;

  dma::AddressSpace& memory_;
  std::shared_ptr<const Model> model_;
  std::vector<std::uint32_t> place_of_;  // empty: particle i lies at i
  std::uint32_t places_;
  dma::Buffer<spu::StrainJob> jobs_;
  dma::Buffer<spu::StrainResult> results_;
  // Empty until a body needs them.
  dma::Buffer<spu::StrainFaces> faces_;
  dma::Buffer<spu::StrainLengths> lengths_;
  bool has_faces_ = false;         // written already, even if there are none
  std::uint32_t edge_groups_ = 0;  // in `lengths_`; the other groups are diagonals
  // SoftBody::rest_revision() of `lengths_`, and at the last look.
  std::optional<std::uint32_t> rest_of_lengths_, seen_rest_;
};

extern template class StrainLooks<2>;
extern template class StrainLooks<3>;

}  // namespace softcell::ppu
