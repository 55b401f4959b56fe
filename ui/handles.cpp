#include "ui/handles.h"

namespace irad {

float handleRadius() {
  return 0.45f * ImGui::GetFontSize();
}

void drawHandleLine(ImDrawList& list, glm::vec2 from, glm::vec2 to, ImU32 color) {
  list.AddLine(toImVec(from), toImVec(to), kHandleEdge, 3.0f);
  list.AddLine(toImVec(from), toImVec(to), color, 1.5f);
}

glm::dvec3 axisVector(int axis) {
  glm::dvec3 vector(0);
  vector[axis] = 1;
  return vector;
}

std::optional<glm::dvec3> movedAlongAxis(const Picture& picture, const glm::dvec3& from, int axis, glm::vec2 mouseFrom,
                                         glm::vec2 mouseTo) {
  const auto nearest = [&](glm::vec2 screen) -> std::optional<double> {
    const auto [start, direction] = picture.ray(screen);
    const glm::dvec3 to = from - start;
    const double cosine = direction[axis], sine2 = 1 - cosine * cosine;
    if (sine2 < 1e-4) return std::nullopt;
    return (cosine * glm::dot(direction, to) - to[axis]) / sine2;
  };
  const std::optional<double> now = nearest(mouseTo), before = nearest(mouseFrom);
  if (!now || !before) return std::nullopt;
  return from + axisVector(axis) * (*now - *before);
}

}  // namespace irad
