#include "gi/mark_corners.h"

#include "gi/facets.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/trace.h"

namespace irad {

void markCorners(Context& context, FacetList& list, uint32_t slots) {
  if (list.count == 0) return;
  Frame frame = context.begin();
  Pass pass = frame.pass("GI CompactList");
  FacetCornersPush push{};
  push.facets = pass.in(list.record);
  pass.out(list.shape);
  pass.out(list.around);
  push.dims = list.grid.dims;
  push.slots = slots;
  pass.shader("gi/facet_corners.comp").constant(CONSTANT_NORMALS, list.encoding).push(push).dispatch(list.count);
  frame.submit();
}

}  // namespace irad
