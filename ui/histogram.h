// The histogram of the picture that the viewport shows: counted on the device when the picture changes, while the panel
// shows it.
#pragma once

#include <cstdint>
#include <optional>

#include "gi/views/histogram.h"

namespace irad {

struct Session;

class ShownHistogram {
 public:
  bool luminance = false;         ///< of it, rather than of red, green and blue
  bool wanted = false;            ///< the panel has drawn it in this frame
  std::optional<glm::vec2> axis;  ///< kept while an end of the range is dragged along it
  /// An end of the range that the mouse is on, or has hold of.
  struct End {
    enum class Which { None, Low, High } which = Which::None;
    float mouse = 0;   ///< where it was when it came there, screen
    float beside = 0;  ///< how far from the end
  } over, held;
  struct Counts {
    Histogram histogram;
    View view;
    bool difference;  ///< of B less A
  };
  std::optional<Counts> counts;  ///< none until they have come back

  /// After the frame's picture was drawn.
  void record(Session& session, Frame& frame);

 private:
  struct Asked {
    uint64_t picture;
    View view;
    bool difference;
    std::optional<glm::vec2> axis;
    bool operator==(const Asked&) const = default;
  };
  std::optional<Asked> asked_;
  HistogramCounter counter_;
};

/// In the panel View: the counts on a logarithmic scale; the ends of the range are dragged on it.
void drawHistogram(Session& session, const ViewInfo& info);

}  // namespace irad
