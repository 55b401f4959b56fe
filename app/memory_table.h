// T Table 1 beside what is here (gi/thesis/memory.h), as cells.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gi/thesis/memory.h"

namespace irad::app {

std::string mebibyteNumber(uint64_t bytes);
std::string byteNumber(uint64_t bytes);
/// subsystem, buffer, formula, thesis, predicted, measured, here; the heading first, `unit` part of its names.
std::vector<std::vector<std::string>> memoryCells(const ThesisTable& table, const char* unit,
                                                  std::string (*text)(uint64_t));

}  // namespace irad::app
