// Writeback of reflections (docs/method.md 8, T 5.12): what a picture shows of them becomes W, a source of the facets
// that show it, for the next relight.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "renderer/resources.h"
#include "shaders/shared/writeback.h"

namespace irad {

class Context;
class Frame;
struct Lighting;
struct Settings;
struct Targets;
struct ViewInputs;

/// What a picture has written back.
struct WritebackReport {
  bool pending = true;                             ///< the picture's frame has not finished: the rest is not known yet
  bool taken = false;                              ///< W is, or will be, a source: takeDrawn()
  std::array<uint32_t, WRITEBACK_BINS> writers{};  ///< visible facets with 0, 1, ... 7 writers, and with more
  uint32_t stores = 0;                             ///< pixels that wrote
  float change = 0;                                ///< largest difference to the W that light was solved with, W/m^2
  float largest = 0;                               ///< W, W/m^2
  uint32_t visible() const;                        ///< facets that a pixel sees
  uint32_t written() const { return visible() - writers[0]; }
};

/// Of the facets, where reflections are written back; otherwise without a buffer.
struct Writeback {
  Buffer used;             ///< vec4 per facet: W that B is solved with, W/m^2
  Buffer drawn;            ///< likewise of the picture that was drawn last; w: writers
  Buffer pixels, writers;  ///< uint per facet: that see it in that picture; of those, that write (mode mask)
  Buffer sums;             ///< mode compute: 3 WRITEBACK_PARTS uints per facet
  Image stored;            ///< mode mask: a texel per facet
  Buffer counts;           ///< one WritebackCounts
  /// Of `drawn`; null before a picture. Shared with the frame that brings it.
  std::shared_ptr<WritebackReport> report;
};

/// Makes or frees what the settings call for. Both W of what is new are 0.
void fitWriteback(Context& context, uint32_t facets, const Settings& settings, Writeback& writeback);
/// What was drawn last is what light is solved with from now on.
void takeDrawn(Writeback& writeback);

/// "GI Writeback", after traceSpecular(): inputs.written becomes what the picture in `targets` shows. `beyond`: the
/// largest radiance that comes from where no surface is, W/(m^2 sr). Records nothing where there are no reflections.
void writeBack(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings, float beyond,
               const Targets& targets);

}  // namespace irad
