// Views by name.
#pragma once

#include <string>
#include <vector>

#include "gi/views.h"

namespace irad::app {

/// Names to views, in order, `all` standing for every one; UsageError lists near matches of an unknown name.
std::vector<ViewInfo> findViews(const std::vector<std::string>& names);

}  // namespace irad::app
