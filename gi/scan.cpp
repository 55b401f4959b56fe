#include "gi/scan.h"

#include <vector>

#include "shaders/shared/voxelize.h"

namespace irad {

void exclusiveScan(Frame& frame, const char* stage, const Buffer& values, uint32_t count, const Buffer& total) {
  if (count == 0) {
    frame.pass(stage).fill(total, 0);
    return;
  }
  // Upwards: level k scans every SCAN_BLOCK^k-th element, whose value is the sum of its block of level k - 1.
  std::vector<ScanPush> levels;
  ScanPush push{};
  push.count = count;
  push.stride = 1;
  for (;;) {
    const uint32_t blocks = (push.count - 1) / SCAN_BLOCK + 1;
    push.last = blocks == 1;
    Pass pass = frame.pass(stage);
    push.values = pass.out(values);
    push.total = pass.out(total);
    pass.shader("gi/scan.comp").push(push).dispatchWorkgroups(blocks);
    levels.push_back(push);
    if (blocks == 1) break;
    push.count = blocks;
    push.stride *= SCAN_BLOCK;
  }
  // Downwards: what precedes a block is added to its elements.
  for (size_t level = levels.size() - 1; level-- > 0;) {
    Pass pass = frame.pass(stage);
    levels[level].values = pass.out(values);
    levels[level].total = 0;
    pass.shader("gi/scan_add.comp").push(levels[level]).dispatch(levels[level].count);
  }
}

}  // namespace irad
