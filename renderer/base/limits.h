// How large a number may be that comes from a file or a person.
#pragma once

namespace irad {

constexpr double kMaxCoordinate = 1e15;  ///< of world positions, either sign: squares and their sums fit into fp32

}  // namespace irad
