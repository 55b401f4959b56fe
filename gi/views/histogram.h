// How often values occur in the picture of a view.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "gi/views/views.h"
#include "renderer/resources.h"

namespace irad {

class Frame;

/// Seeds have no order: they are not counted.
bool hasHistogram(const ViewInfo& info);

/// The device's part of it.
class HistogramCounter {
 public:
  /// Counts the values of `linear`, a view's linear picture, in bins of one width; `done` gets them with the frame. The
  /// axis: of colours 0 to 1, of normals -1 to 1, of light from 0 to what all but 1 % of the luminances stay below,
  /// else all values and the ends of `shown`, the range that the picture was drawn with (null: none). `axis`: this one
  /// instead.
  void count(Frame& frame, const ViewInfo& info, const Image& linear, const Buffer* shown,
             const std::optional<glm::vec2>& axis, std::function<void(const Histogram&)> done);

 private:
  Buffer values_, bins_, histogram_;
};

}  // namespace irad
