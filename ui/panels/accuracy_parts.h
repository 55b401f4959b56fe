// What the panel Accuracy is put together from: a part for each of its questions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gi/study/front.h"
#include "gi/study/slope.h"
#include "renderer/base/timings.h"
#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/widgets.h"

namespace irad {

/// Text of several lines, as wide as the panel.
void accuracyParagraph(const ImVec4& color, const std::string& text);
/// "12 %", ".3 %"
std::string sharePercent(double share);
std::string nameOfView(View view);

/// How far the picture is from the reference, what is known without one, which stage it is. `place`: of the settings in
/// the study that was loaded; null: none that counts.
void drawError(Session& session, const PlaceInStudy* place);

/// The reference: what it is, how it is shown, how one is made and saved.
void drawReference(Session& session);

/// What build, relight and frame take, and how many frames are to come.
class AccuracyTimes {
 public:
  void draw(const Session& session);

 private:
  std::vector<Timings::Row> rows_;
  uint64_t rowsOf_ = UINT64_MAX;
  Refresh refresh_;
};

/// A study's front with the settings as they are.
class AccuracyStudy {
 public:
  /// To be called before place() is asked.
  void find(const Session& session);
  /// The point nearest to the settings; null: no study is loaded, or it is not of this picture.
  const PlaceInStudy* place() const { return place_ ? &*place_ : nullptr; }
  void draw(Session& session);

 private:
  void drawOrigin(Session& session, const LoadedStudy& study) const;
  void drawFront(Session& session, const LoadedStudy& study);
  const CostKind& chooseCost();
  void take(Session& session, const Settings& from);
  void drawPlace(const LoadedStudy& study, const CostKind& kind, const std::vector<CostAndError>& pairs) const;

  Misfit misfit_;                      ///< of the study, now
  size_t cost_ = 0;                    ///< of costKinds()
  std::optional<PlaceInStudy> place_;  ///< of the settings among the study's points
  uint64_t placeIn_ = 0;               ///< Accuracy::studies
  Settings placeOf_;
  std::optional<Settings> before_;  ///< settings before a point's were taken
};

}  // namespace irad
