// How far the picture is from the truth and what it costs: the error as it is now, the reference that it is held
// against, milliseconds, a study's front with the settings as they are.
#include "ui/panel.h"
#include "ui/panels/accuracy_parts.h"
#include "ui/theme.h"

namespace irad {
namespace {

class AccuracyPanel : public Panel {
 public:
  const char* title() const override { return "Accuracy"; }
  const char* help() const override {
    return "How far the picture is from a reference, how long it takes, and what more time would buy";
  }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    session.accuracy.open = true;
    if (!session.built) {
      ImGui::TextColored(theme::dim, "no picture yet");
      return;
    }
    study_.find(session);
    drawError(session, study_.place());
    ImGui::Separator();
    drawReference(session);
    ImGui::Separator();
    times_.draw(session);
    ImGui::Separator();
    study_.draw(session);
  }

 private:
  AccuracyTimes times_;
  AccuracyStudy study_;
};

}  // namespace

std::unique_ptr<Panel> makeAccuracyPanel() {
  return std::make_unique<AccuracyPanel>();
}

}  // namespace irad
