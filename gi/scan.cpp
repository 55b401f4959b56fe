#include <vector>

#include "gi/stages.h"
#include "shaders/shared/voxelize.h"

namespace irad {

void exclusiveScan(Frame& frame, const char* stage, const Buffer& values, uint32_t count, const Buffer& total) {
  if (count == 0) {
    frame.pass(stage).fill(total, 0);
    return;
  }
  // Upwards: level k scans every SCAN_BLOCK^k-th element, whose value is the sum of its block of level k - 1.
  std::vector<ScanPush> levels;
  ScanPush push{.values = values.address, .total = total.address, .count = count, .stride = 1, .last = 0};
  for (;;) {
    const uint32_t blocks = (push.count - 1) / SCAN_BLOCK + 1;
    push.last = blocks == 1;
    frame.pass(stage).shader("gi/scan.comp").write(values, total).push(push).dispatch(uint64_t{blocks} * 64);
    levels.push_back(push);
    if (blocks == 1) break;
    push.count = blocks;
    push.stride *= SCAN_BLOCK;
  }
  // Downwards: what precedes a block is added to its elements.
  for (size_t level = levels.size() - 1; level-- > 0;)
    frame.pass(stage).shader("gi/scan_add.comp").write(values).push(levels[level]).dispatch(levels[level].count);
}

}  // namespace irad
