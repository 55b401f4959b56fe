// What writeback does to a scene, in figures (docs/method.md 8): of `irad writeback` and of the hard cases.
#pragma once

#include "gi/pipeline.h"
#include "gi/writeback.h"

namespace irad {

struct WritebackFigures {
  WritebackRounds rounds;  ///< until pictures and light agreed
  WritebackReport report;  ///< of the last picture; empty where nothing is written back
  double ms = 0;           ///< GPU milliseconds of "GI Writeback" in a picture, by the median
  double meanB = 0;        ///< by the facets' areas and over the still frames, mean of the channels, W/m^2
  /// Standard deviation of a facet's B over the still frames, root mean square by the facets' areas, as a share of
  /// meanB.
  double flicker = 0;
  /// Of the visible facets.
  double share(uint32_t facets) const { return report.visible() > 0 ? double(facets) / report.visible() : 0; }
  uint32_t several() const { return report.written() - report.writers[1]; }  ///< facets with more than one writer
};

/// Lets a pipeline that is current() settle, then draws `frames` pictures of a camera that stands still, as the window
/// does: what is not asleep is prepared in between. The context's timings are begun anew.
WritebackFigures measureWriteback(Context& context, Pipeline& pipeline, const Camera& camera, glm::uvec2 size,
                                  uint32_t frames, const Progress& progress = {});

}  // namespace irad
