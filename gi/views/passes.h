// The passes that draw views, one file each. All but the first leave the display picture to finishView.
#pragma once

#include "gi/views/draw.h"
#include "renderer/resources.h"

namespace irad {

/// Over the targets of the forward pass; draws the display picture too where the view's kind has no range. The sky is
/// behind the scene, where light is shown.
void drawTargets(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                 Targets& targets);
/// Over the voxels.
void drawVoxels(Frame& frame, const ViewInfo& info, const ViewInputs& inputs, const Buffer& camera,
                const Settings& settings, Targets& targets);
/// Over the depth target and the voxels.
void drawPinHoles(Frame& frame, const ViewInputs& inputs, const Buffer& camera, Targets& targets);
/// The shadow map of light settings.view.light, or where its light arrives on the targets; empty where there is no such
/// light or it has no map.
void drawShadowView(Frame& frame, const ViewInfo& info, const ViewInputs& inputs, const Buffer& camera,
                    const Settings& settings, Targets& targets);
/// The reference picture, or what targets.linear holds against it. Empty without one.
void drawReference(Frame& frame, const ViewInfo& info, const ViewInputs& inputs, Targets& targets);

/// Finds the range that a view is drawn with, or that of a view of light's luminances (autoExposure()), from
/// targets.linear and settings.view, into targets.viewRange.
void findRange(Frame& frame, const ViewInfo& info, const Settings& settings, Targets& targets);
/// The same of any linear picture, with what `push` says beside the addresses: into `range`, with `bins` for
/// percentiles.
void measureRange(Frame& frame, const char* stage, RangePush push, const Image& linear, const Buffer& range,
                  const Buffer& bins);
/// targets.linear -> targets.display. `dims`: of the grid, for views of its voxels' coordinates.
void finishView(Frame& frame, const ViewInfo& info, const Settings& settings, glm::uvec3 dims, Targets& targets);

float linearExposure(const Settings& settings);
/// A view of light with camera.auto_exposure: its display picture needs the whole linear one first.
bool exposesItself(const ViewInfo& info, const Settings& settings);

}  // namespace irad
