#pragma once
// Finds and solves contacts of soft bodies on SPEs, with the kernels `contact_find` and `contact_solve`, and attachments with `attach`.
//
//     begin   positions, ends, boxes of cells, velocities --> main memory
//     find    a chain of jobs, each for some pairs of bodies
//     solve   a chain with a stage for each of SolveStages, a job for each unit

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "contact_find_job.h"
#include "contact_solve_job.h"
#include "ppu/contact_solver/contact_worker.h"
#include "ppu/spe_bodies/candidate_pairs.h"
#include "ppu/spe_bodies/find_parts.h"
#include "ppu/spe_bodies/spe_attachments.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"

namespace softcell::ppu {

/// The kernels' images; they must outlive the objects that use them.
struct ContactKernels {
  const ls_sim::KernelImage &contact_find, &contact_solve, &attach;
};

/// The result is the same bits for any number of SPEs. Used by one thread. Allocates when there is more to do
/// than ever before.
class SpeContacts final : public ContactWorker {
 public:
  /// `memory` and `jobs` must outlive this object. It needs two chains.
  /// @throws std::runtime_error  main memory is full, or there are too few chains left.
  SpeContacts(dma::AddressSpace& memory, JobSystem& jobs, const ContactKernels& kernels);
  ~SpeContacts() override;

  void forget(const ContactModel& model) override;
  void begin(std::span<const ContactBody> bodies, float step) override;
  bool holds(std::uint32_t body) const override { return places_[body].model != nullptr; }
  void find(std::span<const Pair> pairs) override;
  std::span<const FoundContacts> found() override;
  std::span<spu::SolveContact> room(std::size_t contacts) override;
  std::span<spu::SolveRigid> rigid_room(std::size_t rigids) override;
  void hold(std::span<const AttachUnit> units, std::uint32_t iterations) override;
  void read(std::span<AttachUnit> units) const override { attachments_.read(units); }
  void solve(const SolveStages& stages) override;
  void take(std::uint32_t body, std::span<Eigen::Vector3f> velocities,
            std::span<Eigen::Vector3f> pushes) const override;
  void put(std::uint32_t body, std::span<const Eigen::Vector3f> velocities,
           std::span<const Eigen::Vector3f> pushes) override;

 private:
  /// A model in main memory, and constants that its bodies need.
  struct Model {
    dma::Buffer<spu::FindCell> cells;
    dma::Buffer<spu::FindGroup> groups;
    std::vector<float> root_masses, inverse_root_masses;
  };
  /// Where a body's arrays begin.
  struct Place {
    const Model* model = nullptr;  ///< null: the body is too large
    std::size_t state = 0, velocities = 0, particles = 0;
  };
  /// The tasks of a pair in find_tasks_.
  struct Asked {
    std::uint32_t first = 0, count = 0;  ///< 0: the two cannot touch
    std::uint32_t first_part = kWhole;   ///< in parts_, one for each task; kWhole: none
    bool by_caller = false;
  };
  static constexpr std::uint32_t kWhole = ~0u;
  const Model* model_of(const ContactModel& contact);
  /// Where the body's SolveTask::start_ea begins in velocities_, and its ends in state_.
  std::size_t start_of(std::uint32_t body) const;
  std::size_t ends_of(std::uint32_t body) const;
  bool find_places(std::size_t& state, std::size_t& velocities);
  void write_boxes(std::uint32_t body);
  void write_particles(std::uint32_t body, bool was_there);
  spu::FindBody find_body(std::uint32_t body);
  void make_room_for_candidates();
  spu::FindTask find_task(std::uint32_t a, std::uint32_t b);
  Asked ask(std::uint32_t a, std::uint32_t b);
  Asked ask_in_parts(const Pair& pair, const spu::FindTask& whole);
  FindParts::Body parts_body(std::uint32_t body) const;
  /// A job that finds contacts: so many tasks from `task` on, and the room for their contacts.
  struct FindPart {
    std::size_t task, tasks;
    dma::EffectiveAddress contacts;
    std::size_t room;
  };
  void add_find_job(std::size_t number, const FindPart& part);
  void find_again();
  FoundContacts found_in_parts(const Asked& asked);
  dma::EffectiveAddress ea_of(const spu::SolveContact* contact) const;
  dma::EffectiveAddress ea_of(const spu::SolveRigid* rigid) const;
  void write_tasks(const SolveGroup& group);
  spu::SolveTask solve_task(const SolveGroup& group, std::span<const spu::SolveContact> contacts, bool last);

  dma::AddressSpace& memory_;
  JobSystem& jobs_;
  JobImage contact_find_, contact_solve_;
  SpeAttachments attachments_;
  std::unordered_map<const ContactModel*, std::unique_ptr<Model>> models_;  // null: the model is too large

  std::span<const ContactBody> bodies_;
  float step_ = 0;
  std::vector<Place> places_;
  std::vector<Bounds<3>> end_boxes_;  // of each body
  CandidatePairs pairs_;

  dma::Buffer<spu::FindEnd> state_;             // for each body: FindBody::state_ea
  dma::Buffer<spu::SolveVelocity> velocities_;  // for each body: changes, pushes, and the start
  std::vector<Eigen::Vector3f> started_;        // of all bodies: velocities at begin()

  dma::Buffer<spu::FindTask> find_tasks_;
  dma::Buffer<spu::FindCandidate> candidates_;  // kFindMaxCandidates for each of pairs_.slots()
  dma::Buffer<spu::FindResult> results_;
  dma::Buffer<spu::FindJob> find_jobs_;
  dma::Buffer<spu::SolveContact> contacts_;            // room_of_job_ elements for each job
  dma::Buffer<spu::SolveContact> more_contacts_;       // kFindMaxContacts for each task of find_again()
  std::vector<dma::Buffer<spu::SolveContact>> rooms_;  // for contacts that the PPU has found
  std::size_t room_ = 0, used_ = 0;                    // the room that is being filled, and its used part
  dma::Buffer<spu::SolveRigid> rigids_;
  FindParts parts_;
  std::vector<spu::FindTask> tasks_;
  std::vector<Asked> asked_;  // for each pair
  // Index in pairs_.known() for each task; kWhole: none, as the task is a part's.
  std::vector<std::uint32_t> known_of_task_;
  std::size_t tasks_of_job_ = 1, room_of_job_ = 0;  // for finding_
  std::vector<std::span<spu::SolveContact>> found_by_task_;
  std::vector<FoundContacts> found_;

  dma::Buffer<spu::SolveTask> solve_tasks_;
  dma::Buffer<spu::SolveJob> solve_jobs_;
  dma::Buffer<spu::SolveCell> cells_;
  std::size_t cells_used_ = 0, tasks_used_ = 0;
  JobChain finding_, solving_;  // last members: chains end before their jobs' memory is freed
};

}  // namespace softcell::ppu
