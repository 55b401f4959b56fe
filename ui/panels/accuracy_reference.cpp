// The panel Accuracy: the reference that the picture is held against.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/panels/accuracy_parts.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/words.h"

namespace irad {
namespace {

std::string secondsText(double seconds) {
  return seconds < 99.5 ? fmt::format("{:.0f} s", std::ceil(seconds)) : fmt::format("{:.0f} min", seconds / 60);
}

/// What the picture is of: for that of a file the user knows.
void drawOf(Session& session, const ReferencePicture& reference) {
  if (session.accuracy.traced()) {
    valueRow("of", nameOfView(reference.of));
    helpTooltip("The view that the reference is a picture of");
    return;
  }
  fieldLabel("of", "The view that the file is a picture of: relMSE and the view error compare with that");
  ImGui::PushID("of");
  if (ImGui::BeginCombo("##", nameOfView(reference.of).c_str())) {
    for (const View view : {View{VIEW_LIT}, View{VIEW_INDIRECT}})
      if (ImGui::Selectable(nameOfView(view).c_str(), view == reference.of)) session.accuracy.referenceOf = view;
    ImGui::EndCombo();
  }
  ImGui::PopID();
}

void drawShow(Session& session, const ReferencePicture& reference) {
  const bool split = session.split && !session.comparison;
  const char* shown = split                                    ? "split"
                      : session.view == VIEW_ERROR             ? "heat map"
                      : session.view == VIEW_REFERENCE_PICTURE ? "reference"
                      : session.view == reference.of           ? "picture"
                                                               : "another view";
  fieldLabel("show", "The picture, the reference, both beside each other, or where they differ (the view error)");
  ImGui::PushID("show");
  if (ImGui::BeginCombo("##", shown)) {
    const auto entry = [&](const char* name, View view, bool splits) {
      if (!ImGui::Selectable(name, std::string_view(name) == shown)) return;
      session.view = view;
      session.split.reset();
      if (splits) session.split.emplace();
      session.viewDirty = true;
    };
    entry("picture", reference.of, false);
    entry("reference", VIEW_REFERENCE_PICTURE, false);
    if (!session.comparison) entry("split", reference.of, true);
    entry("heat map", VIEW_ERROR, false);
    ImGui::EndCombo();
  }
  ImGui::PopID();
}

void drawTracing(Session& session) {
  using What = BackgroundReference::State::What;
  Accuracy& accuracy = session.accuracy;
  const BackgroundReference::State state = accuracy.tracing();
  if (!accuracy.outdated.empty()) accuracyParagraph(theme::warning, "Outdated: " + accuracy.outdated + ".");
  if (state.what == What::Failed) accuracyParagraph(theme::error, "No reference: " + state.error);
  if (state.what == What::Loading || state.what == What::Tracing || state.what == What::Waiting) {
    const std::string text = state.what == What::Loading ? std::string("reading the scene")
                             : state.samples == 0        ? fmt::format("0 of {}", state.wanted)
                                                         : fmt::format("{} of {}, {}", state.samples, state.wanted,
                                                                       secondsText(state.secondsLeft) + " left");
    ImGui::ProgressBar(static_cast<float>(state.samples) / static_cast<float>(std::max(state.wanted, 1u)), {-1, 0},
                       text.c_str());
    if (ImGui::Button("Cancel###cancel reference", {-1, 0})) accuracy.cancelReference = true;
    helpTooltip("Stops tracing; what there is of the reference stays");
    return;
  }
  const bool can = hasPathTracer(), lambertian = session.edited.scene.lambertian;
  fieldLabel("compute",
             "The light to trace. The path tracer knows diffuse surfaces only: it traces indirect light, or with "
             "scene.lambertian (all surfaces diffuse) all of it.");
  ImGui::PushID("compute");
  if (ImGui::BeginCombo("##", accuracy.indirect || !lambertian ? "indirect" : "lit")) {
    if (ImGui::Selectable("indirect", accuracy.indirect || !lambertian)) accuracy.indirect = true;
    ImGui::BeginDisabled(!lambertian);
    if (ImGui::Selectable(lambertian ? "lit" : "lit: with scene.lambertian###lit", !accuracy.indirect && lambertian))
      accuracy.indirect = false;
    ImGui::EndDisabled();
    ImGui::EndCombo();
  }
  ImGui::PopID();
  fieldLabel("samples", "Light paths per pixel. Twice as many take twice as long and leave 0.71 of the noise.");
  ImGui::PushID("samples");
  if (ImGui::BeginCombo("##", std::to_string(accuracy.samples).c_str())) {
    for (const uint32_t samples : {16u, 64u, 256u, 1024u, 4096u})
      if (ImGui::Selectable(std::to_string(samples).c_str(), samples == accuracy.samples)) accuracy.samples = samples;
    ImGui::EndCombo();
  }
  ImGui::PopID();
  ImGui::BeginDisabled(!can);
  if (ImGui::Button("Compute a reference", {-1, 0})) accuracy.wantReference = true;
  ImGui::EndDisabled();
  helpTooltip([&] {
    return fmt::format(
        "A path tracer on the triangles, from this camera and at this size, on {} of the processor's threads at the "
        "lowest priority. It stops where camera, scene, lights or materials change, and pauses while this panel is "
        "folded.",
        BackgroundReference::threads());
  });
  if (!can) accuracyParagraph(theme::dim, "This build has no path tracer (IRAD_EMBREE).");
}

/// That of a file is in one already.
void drawSave(Session& session) {
  Accuracy& accuracy = session.accuracy;
  const float button = ImGui::CalcTextSize("Save").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
  ImGui::InputText("##save as", &accuracy.saveAs);
  helpTooltip(
      fmt::format("A file {}: what there is of the reference, with its standard error as a second layer and "
                  "its camera. --reference takes it, and so does the window when it is dropped there",
                  linearExtension()));
  ImGui::SameLine();
  ImGui::BeginDisabled(accuracy.saving() || accuracy.saveAs.empty());
  if (ImGui::Button("Save###save reference", {button, 0})) accuracy.wantSave = true;
  ImGui::EndDisabled();
  helpTooltip("Writes the reference into the file on the left");
}

}  // namespace

void drawReference(Session& session) {
  Accuracy& accuracy = session.accuracy;
  if (session.reference) {
    const ReferencePicture& reference = *session.reference;
    const glm::uvec2 size = reference.picture.size;
    std::string what =
        accuracy.traced() ? counted(accuracy.traced()->samples, "sample") : reference.path.filename().string();
    valueRow("reference", what);
    helpTooltip([&] {
      return fmt::format("What the picture is compared with.\n{}\n{} \u00D7 {} pixels",
                         accuracy.traced() ? "Path traced here, so many samples per pixel" : reference.path.string(),
                         size.x, size.y);
    });
    if (accuracy.traced()) {
      valueRow("its noise", withDigits(accuracy.traced()->noise));
      helpTooltip(
          "The reference's own error, as a share of its light: \u221ArelMSE of its pixels by their standard errors. In "
          "relMSE above it has been taken out, but for the \u00B1.");
    }
    drawOf(session, reference);
    drawShow(session, reference);
    if (accuracy.traced()) drawSave(session);
  } else {
    accuracyParagraph(theme::dim, "Drop an .exr on the window, or compute one:");
  }
  drawTracing(session);
}

}  // namespace irad
