// The window behind runWindow(), for window*.cpp alone.
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "renderer/presenter.h"
#include "renderer/renderdoc.h"
#include "ui/builder.h"
#include "ui/captures_dialog.h"
#include "ui/imgui_layer.h"
#include "ui/input.h"
#include "ui/open_dialog.h"
#include "ui/panel.h"
#include "ui/unsaved_dialog.h"
#include "ui/viewport.h"
#include "ui/window.h"
#include "ui/work_keeper.h"

namespace irad {

class Window {
 public:
  Window(Context& context, const WindowOptions& options);
  void run();

 private:
  void open(const std::filesystem::path& path);
  void sceneOpened();
  void breathe();
  void takeKeys();
  void takeRequests();
  void capture();
  void frame();
  void captureFrame();
  void readPreferences();
  void savePreferences();
  void offerFound();
  void answerOffer(Session::Offer answer);
  bool take(const Autosave& found);
  bool bringBack(const std::filesystem::path& scene, const Settings& settings, const std::optional<Settings>& other,
                 const std::string& step, const std::function<void(EditState&)>& give);
  template <class Picture>
  void bring(std::shared_ptr<const Picture>& into, const std::optional<std::filesystem::path>& file,
             const std::optional<std::string>& sha256, Picture (*read)(const std::filesystem::path&));
  void replay(const std::filesystem::path& manifest);
  void fly();
  void drawFrame();
  std::array<uint64_t, 5> drawnSoFar() const;
  bool working() const;
  bool settled() const;
  bool measured();
  void chooseAll();
  void wait();

  using Clock = std::chrono::steady_clock;

  Context& context_;
  const WindowOptions& options_;
  Session session_;
  Presenter presenter_;
  Input input_;
  ImGuiLayer layer_;
  std::optional<Controls> controls_;  ///< asked for by a test
  Builder builder_;
  Viewport viewport_;
  OpenDialog openDialog_;
  UnsavedDialog unsavedDialog_;
  CapturesDialog capturesDialog_;
  Panels panels_ = makePanels();
  std::optional<RenderDoc> renderDoc_ = RenderDoc::find();
  Image image_;                              ///< the whole window
  bool visible_ = true;                      ///< the last frame had something to be drawn on
  bool same_ = false;                        ///< the last frame would have shown what the one before had
  std::array<uint64_t, 5> shownAt_{};        ///< drawnSoFar() when it had been shown
  static constexpr int kFramesPerEvent = 3;  ///< ImGui needs a few to settle after an event
  int framesLeft_ = kFramesPerEvent;
  uint32_t settledFrames_ = 0;
  bool measuring_ = false, choseAll_ = false;  ///< for WindowOptions::measuredFrames
  uint64_t frameIndex_ = 0;
  Clock::time_point lastDraw_;
  Preferences saved_;         ///< as the file has them
  bool compiling_ = false;    ///< the context has variants to compile
  bool toldUnsaved_ = false;  ///< the user was told that it cannot be written
  BackgroundWorker writer_;   ///< of the preferences and of what is kept against a crash
  WorkKeeper keeper_;
  std::filesystem::path historyOf_;  ///< the scene whose edits session_.history holds
};

}  // namespace irad
