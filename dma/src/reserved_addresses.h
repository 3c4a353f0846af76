#pragma once

namespace softcell::dma {

/// Keeps the host addresses that are numerically equal to effective addresses inaccessible, so that a kernel
/// which follows an effective address as a pointer faults there and nowhere else. Once per process, for its
/// whole life; best effort: what is already mapped stays as it is. Any thread.
void reserve_effective_addresses();

}  // namespace softcell::dma
