// The time that pipelines cost where they are used for the first time.
#pragma once

namespace irad {

class Context;

/// Milliseconds so far in which passes waited for pipelines that were not there yet: what is recorded the same way
/// again does not.
double pipelineWaitMs(const Context& context);

}  // namespace irad
