// What the rays of a chunk of rows met -> the rows' entries (docs/method.md 5): sorted, equal columns merged.
#pragma once

#include <span>
#include <vector>

#include "renderer/frame/frame.h"
#include "shaders/shared/matrix_build.h"

namespace irad {

struct Chunk {
  uint32_t firstRow = 0, rows = 0, rays = 0, columnBits = 0;
};

/// On the device, one workgroup per row: in `hits` every row's entries replace its hits; counts, rowInfo and sums
/// follow. `rowSky`: where the hits tell rays that escape by bins.
void mergeOnDevice(Frame& frame, const Chunk& chunk, const Buffer& hits, const Buffer& counts, const Buffer& rowInfo,
                   const Buffer& sums, const Buffer* rowSky = nullptr);

/// On the host, with the same result: for CPU devices, whose memory this is anyway and whose workgroups are slow at
/// sorting. `hits` is mapped; `info`, `start` and, where it is wanted, `sky` are the chunk's; the packed entries are
/// returned.
std::vector<uint32_t> mergeOnHost(const Chunk& chunk, std::span<uint32_t> hits, std::span<glm::uvec2> info,
                                  std::span<uint32_t> start, ChunkCounts& sums, std::span<uint32_t> sky = {});

}  // namespace irad
