// Two sides of the same scene, in numbers.
#pragma once

#include "ui/session.h"

namespace irad {

/// Fills session.comparison->result once both sides are asleep and drawn. Reads pictures and light back: once per
/// change.
void measureComparison(Context& context, Session& session);

}  // namespace irad
