#include "demo_pages.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace softcell::demos {

Page DemoPages::next(const Demo& demo, const FrameTimes& times, const Look& look, int width, int height) {
  std::vector<ls_sim::SpeStatistics> now = demo.spe_statistics();
  before_.resize(now.size());
  Page page{.look = look,
            .width = width,
            .height = height,
            .scene = demo.scene_name(),
            .dimension = demo.dimension(),
            .counts = demo.counts(),
            .times = times,
            .paused = demo.paused(),
            .replays = demo.replays(),
            .spes = now.size(),
            .spe_ms = 0,
            .dma_bytes = 0};
  for (std::size_t i = 0; i < now.size(); ++i) {
    const std::chrono::duration<double, std::milli> busy = now[i].busy - before_[i].busy;
    page.spe_ms = std::max(page.spe_ms, busy.count());
    page.dma_bytes += now[i].dma.bytes() - before_[i].dma.bytes();
  }
  before_ = std::move(now);
  return page;
}

}  // namespace softcell::demos
