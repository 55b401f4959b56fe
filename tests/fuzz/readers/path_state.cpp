// .state, the path tracer's sums that `irad reference --resume` goes on with.
#include "gi/check/path_state.h"

#include "tests/fuzz/readers.h"

void irad::fuzz::path_state(Bytes bytes) {
  const SavedSums saved = readSums(scratchFile("picture.state", bytes));
  const size_t pixels = size_t{saved.sums.size.x} * saved.sums.size.y;
  if (saved.sums.samples == 0 || saved.sums.lit.squares.size() != pixels || saved.made.empty())
    throw Unsound("sums that say nothing");
}
