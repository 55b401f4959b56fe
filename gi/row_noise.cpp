#include "gi/row_noise.h"

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/sweep.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {

void rowNoise(Frame& frame, const FacetList& facets, const FormFactors& matrix, const SolverSettings& settings,
              const Lighting& light, const Buffer& squares, const Buffer& error) {
  constexpr const char* kStage = "GI Scatter";
  const Buffer& lightSquares = light.radiosityNext;
  const bool sampled = static_cast<bool>(light.correction);
  {
    Pass pass = frame.pass(kStage);
    LightSquaresPush push{};
    push.facets = pass.in(facets.record);
    push.radiosity = pass.in(light.radiosity);
    push.output_ = pass.out(lightSquares);
    push.emissionGain = sampled ? light.gain.radiosity : 0;
    pass.shader("gi/light_squares.comp").push(push).dispatch(facets.count);
  }
  Sweep sweep(frame.context(), facets, matrix, settings);
  sweep.record(frame, kStage, SOLVE_PRODUCT, lightSquares, squares, light);

  Pass pass = frame.pass(kStage);
  RowNoisePush push{};
  push.matrix = pass.in(matrix.record);
  push.squares = pass.in(squares);
  push.indirect = pass.in(light.indirect);
  if (sampled) push.emitted = pass.in(light.emitted);
  push.emittedGain = sampled ? light.gain.indirect : 0;
  push.sky = pass.inIfAny(light.sky);
  push.error = pass.out(error);
  pass.shader("gi/row_noise.comp")
      .constant(CONSTANT_SKY, static_cast<bool>(light.sky))
      .push(push)
      .dispatch(matrix.rows);
}

}  // namespace irad
