#include "ui/window.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/presenter.h"
#include "renderer/renderdoc.h"
#include "ui/bindings.h"
#include "ui/builder.h"
#include "ui/capture.h"
#include "ui/comparison.h"
#include "ui/imgui.h"
#include "ui/imgui_layer.h"
#include "ui/input.h"
#include "ui/open_dialog.h"
#include "ui/overlay.h"
#include "ui/panel.h"
#include "ui/pictures.h"
#include "ui/theme.h"
#include "ui/unsaved_dialog.h"
#include "ui/viewport.h"

namespace irad {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kBusyInterval{100};  ///< between frames while a load or a rebuild runs
constexpr double kHiddenInterval = 0.1;  ///< seconds between looks whether a window without area has one again
constexpr double kWatchInterval = 0.2;   ///< seconds between frames while all that goes on is a reference
constexpr int kFramesPerEvent = 3;       ///< ImGui needs a few to settle after an event

/// CPU time of this thread, ms: what drivers and other programs do meanwhile is not counted.
double threadMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

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
  void fly();
  void drawFrame();
  bool working() const;
  bool settled() const;
  bool measured();
  void wait();

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
  Panels panels_ = makePanels();
  std::optional<RenderDoc> renderDoc_ = RenderDoc::find();
  Image image_;          ///< the whole window
  bool visible_ = true;  ///< the last frame had something to be drawn on
  int framesLeft_ = kFramesPerEvent;
  uint32_t settledFrames_ = 0;
  bool measuring_ = false;
  uint64_t frameIndex_ = 0;
  Clock::time_point lastDraw_;
  Preferences saved_;         ///< as the file has them
  bool compiling_ = false;    ///< the context has variants to compile
  bool toldUnsaved_ = false;  ///< the user was told that it cannot be written
};

Window::Window(Context& context, const WindowOptions& options)
    : context_(context),
      options_(options),
      session_(context),
      presenter_("irad", static_cast<int>(options.size.x), static_cast<int>(options.size.y)),
      input_(presenter_.window()),
      layer_(context, presenter_.window()),
      builder_(context, session_, [this] { breathe(); }),
      unsavedDialog_(options.captures) {
  presenter_.attach(context);
  context.bridgeVariants(true);
  session_.edited = session_.saved = options.settings;
  session_.defaults = options.defaults;
  session_.view = options.view;
  session_.reference = options.reference;
  session_.load = options.load;
  session_.builtIn = options.builtIn;
  session_.exposes = options.exposes;
  session_.underRenderDoc = renderDoc_.has_value();
  session_.presets = options.presets;
  if (!options.controls.empty()) controls_.emplace(options.controls);
  readPreferences();
}

void Window::readPreferences() {
  if (options_.preferences.empty()) return;
  try {
    session_.preferences = irad::readPreferences(options_.preferences);
  } catch (const Error& error) {
    session_.error(fmt::format("The layout is that of a first start. {}", error.what()));
  }
  saved_ = session_.preferences;
}

/// Once per change, and not while the mouse is making it. A folder that cannot be written into is reported once.
void Window::savePreferences() {
  if (options_.preferences.empty() || session_.preferences == saved_ || ImGui::IsAnyItemActive()) return;
  saved_ = session_.preferences;
  try {
    writePreferences(options_.preferences, saved_);
  } catch (const Error& error) {
    if (!std::exchange(toldUnsaved_, true))
      session_.error(fmt::format("The layout is not remembered. {}", error.what()));
  }
}

void Window::run() {
  builder_.load(options_.scene);
  sceneOpened();
  if (options_.camera.empty() && options_.start && session_.pipeline) session_.startAt(*options_.start);
  if (!options_.camera.empty() && session_.pipeline) {
    const std::vector<Camera> cameras = session_.cameras();
    const auto named =
        std::find_if(cameras.begin(), cameras.end(), [&](const Camera& c) { return c.name == options_.camera; });
    if (named == cameras.end())
      throw UsageError(fmt::format("--camera {}: the scene has no camera of that name", options_.camera));
    session_.useSceneCamera(static_cast<int>(named - cameras.begin()));
  }
  if (options_.inspect && session_.pipeline) session_.inspection.open(session_, *options_.inspect);
  while (!session_.quit) {
    wait();
    takeKeys();
    try {
      takeRequests();
      if (std::exchange(session_.captureFrame, false))
        captureFrame();
      else
        frame();
    } catch (const Error& error) {
      // A frame that failed before it was drawn would fail again at once: stop, unless a smaller picture may do.
      if (session_.halted || !session_.pipeline) throw;
      session_.halted = true;
      session_.error(error.what());
    }
    if (options_.exitAfter > 0 && settled() && ++settledFrames_ >= options_.exitAfter) break;
    if (options_.measuredFrames > 0 && measured()) break;
  }
  if (!options_.screenshot.empty() && image_) saveScreenshot(context_, image_, options_.screenshot);
}

/// Keeps pictures coming once the light is at rest; true when enough of them have been measured.
bool Window::measured() {
  if (!measuring_ && settled()) measuring_ = true;
  session_.viewDirty |= measuring_;
  return options_.uiMilliseconds->size() >= options_.measuredFrames;
}

/// There is something to do that needs no frame.
bool Window::working() const {
  return session_.work || session_.openScene || session_.openPicture || session_.capture || session_.captureAll ||
         session_.captureFrame || session_.reloadShaders || session_.rebuild || session_.compare ||
         session_.inspection.wanted() || session_.accuracy.measuring() || builder_.stale() ||
         (session_.pipeline && !session_.halted && !session_.paused && !session_.allAsleep());
}

bool Window::settled() const {
  // What waits for a slider to be let go, or for a number to be typed to its end, takes an event to go on.
  const bool due = session_.next != Redo::Nothing && !ImGui::IsAnyItemActive();
  return !working() && !session_.viewDirty && !due && context_.variantsCompiling() == 0;
}

/// Sleeps until there is an event, when nothing is left to do: an idle window does no work on either processor.
/// Wake-ups that bring none (the display answering a presentation) let it sleep again.
void Window::wait() {
  const bool hidden = !visible_ && !working();
  const bool typing = ImGui::GetIO().WantTextInput || session_.dialogOpen();  // keys that are held fly nowhere
  const bool idle = settled() && framesLeft_ <= 0 && (typing || !input_.flying()) && options_.exitAfter == 0;
  const bool blinks = idle && ImGui::GetIO().WantTextInput;     // the text cursor
  const bool watches = idle && session_.accuracy.tracingNow();  // its progress
  if (hidden)
    glfwWaitEventsTimeout(kHiddenInterval);
  else if (!idle)
    glfwPollEvents();
  else if (watches)
    glfwWaitEventsTimeout(kWatchInterval);
  else if (blinks)
    glfwWaitEventsTimeout(0.4);
  else
    glfwWaitEvents();
  if (input_.takeEvent())
    framesLeft_ = kFramesPerEvent;
  else if (blinks || watches || hidden)
    framesLeft_ = 1;
}

void Window::takeKeys() {
  if (glfwWindowShouldClose(presenter_.window())) {
    glfwSetWindowShouldClose(presenter_.window(), GLFW_FALSE);
    session_.leave({Leaving::What::Quit});
    framesLeft_ = kFramesPerEvent;  // for the question
  }
  for (const std::filesystem::path& path : input_.takeDrops()) session_.open(path);
  const std::vector<Input::Press> presses = input_.takePresses();
  if (ImGui::GetIO().WantTextInput) return;
  for (const Input::Press& press : presses) {
    const std::span<const Binding> all = bindings();
    const auto binding = std::find_if(all.begin(), all.end(), [&](const Binding& b) {
      return b.key == press.key && (press.shift || !b.shift) && (press.control || !b.control);
    });
    if (session_.dialogOpen() && press.key != GLFW_KEY_ESCAPE) continue;
    if (binding != all.end()) session_.act(binding->action);
    const auto number = static_cast<size_t>(press.key - GLFW_KEY_1);
    if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9 && number < views().size()) {
      session_.view = views()[number].view;
      session_.viewDirty = true;
    }
  }
}

void Window::takeRequests() {
  savePreferences();
  if (std::exchange(session_.reloadShaders, false)) builder_.reloadShaders(options_.shaders);
  serveRecorder(session_, options_.captures);
  if (session_.openPicture) builder_.openPicture(*std::exchange(session_.openPicture, std::nullopt));
  if (std::exchange(session_.darken, false)) builder_.darken();
  if (std::exchange(session_.rebuild, false)) session_.halted = false;
  if (const std::optional<bool> compare = std::exchange(session_.compare, std::nullopt)) {
    if (*compare)
      builder_.compare();
    else
      session_.comparison.reset();
  }
  if (session_.comparison && !session_.viewDirty) measureComparison(context_, session_);
  if (session_.openScene) open(*std::exchange(session_.openScene, std::nullopt));
}

/// What the settings call for, and a picture of it.
void Window::frame() {
  builder_.apply(/*held=*/ImGui::IsAnyItemActive());
  if (session_.inspection.serve(session_)) framesLeft_ = std::max(framesLeft_, kFramesPerEvent);
  if (session_.accuracy.serve(session_)) framesLeft_ = std::max(framesLeft_, kFramesPerEvent);
  fly();  // first: on a slow machine the keys of a flight and the key that saves arrive together
  capture();
  // The pipelines that stood in until the variants came may have shown an effect that is switched off.
  const bool compiling = context_.variantsCompiling() > 0;
  if (std::exchange(compiling_, compiling) && !compiling) session_.viewDirty = true;
  if (framesLeft_ > 0 || !settled() || options_.exitAfter > 0) drawFrame();
}

void Window::captureFrame() {
  session_.viewDirty = true;
  const std::string scene = session_.pipeline ? session_.pipeline->scene().path.stem().string() : "irad";
  try {
    makeFolder(options_.captures);
    const std::filesystem::path file =
        renderDoc_->capture(context_.device, options_.captures / scene, [this] { frame(); });
    session_.note(fmt::format("RenderDoc saved {}", file.string()));
  } catch (const WorkError& error) {
    session_.error(error.what());
  }
}

/// Captures that were asked for are saved once the light is done, unless the solver is stopped.
void Window::capture() {
  if (!session_.capture && !session_.captureAll) return;
  if (session_.pipeline && !session_.allAsleep() && !session_.paused && !session_.halted) return;
  session_.work = Work{.what = session_.captureAll ? "Saving all views" : "Saving the view"};
  const bool all = std::exchange(session_.captureAll, false);
  session_.capture = false;
  // Files hold exactly what the settings say: no pipeline may stand in for another.
  struct Exact {
    Context& context;
    explicit Exact(Context& c) : context(c) { context.bridgeVariants(false); }
    ~Exact() { context.bridgeVariants(true); }
  } exact(context_);
  saveCapture(session_, all, options_.captures, options_.program, [this](const char* stage, float fraction) {
    session_.work->stage = stage;
    session_.work->fraction = fraction;
    breathe();
    return !session_.work->cancel;
  });
  session_.work.reset();
  framesLeft_ = kFramesPerEvent;
}

/// The scene's file in the window's title, and among those opened lately.
void Window::sceneOpened() {
  if (!session_.pipeline) return;
  std::error_code ignored;
  const std::filesystem::path& path = session_.pipeline->scene().path;
  if (std::filesystem::exists(path, ignored)) session_.preferences.opened(path);
  const std::string file = session_.pipeline->scene().path.filename().string();
  glfwSetWindowTitle(presenter_.window(), fmt::format("irad \u2014 {}", file).c_str());
}

void Window::open(const std::filesystem::path& path) {
  try {
    builder_.load(path);
    sceneOpened();
  } catch (const Error& error) {
    session_.error(error.what());
  }
  framesLeft_ = kFramesPerEvent;
}

/// Called in the middle of a load or a rebuild: events, and now and then a frame.
void Window::breathe() {
  if (Clock::now() - std::max(lastDraw_, session_.work->began) < kBusyInterval) return;
  glfwPollEvents();
  takeKeys();
  drawFrame();
}

void Window::fly() {
  const glm::vec3 seconds = input_.takeMovement();
  if (ImGui::GetIO().WantTextInput || session_.dialogOpen() || seconds == glm::vec3(0.0f)) return;
  session_.camera.move(seconds, input_.shift() ? 4.0f : input_.control() ? 0.25f : 1.0f);
  session_.viewDirty = true;
}

void Window::drawFrame() {
  const glm::uvec2 size = presenter_.framebufferSize();
  if (size.x == 0 || size.y == 0) framesLeft_ = 0;  // iconified: until the next event
  visible_ = presenter_.acquire();
  if (!visible_) return;
  lastDraw_ = Clock::now();
  const bool busy = session_.work.has_value();
  // The last frame before the sleep shows the times of all others: only it waits for them.
  if (framesLeft_ <= 1 && settled())
    context_.finish();
  else
    context_.collect();
  if (image_.desc.width != size.x || image_.desc.height != size.y)
    image_ = Image(context_.device, ImageDesc{.name = "window",
                                              .subsystem = Subsystem::Ui,
                                              .format = VK_FORMAT_R8G8B8A8_UNORM,
                                              .width = size.x,
                                              .height = size.y,
                                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
  float contentScale = 1, ignored = 1;
  glfwGetWindowContentScale(presenter_.window(), &contentScale, &ignored);
  layer_.setScale(contentScale * options_.scale);

  const Layout where = layout(size, layer_.scale(), session_.hideUi, session_.preferences.sizes);
  const glm::uvec2 picture = glm::max(glm::uvec2(where.viewport.size), glm::uvec2(1));
  // While a rebuild runs the last picture is shown, stretched if need be.
  if (!busy && session_.built)
    for (Side* side : session_.sides())
      if (side->targets.size != picture) {
        side->targets = Targets(context_, picture);
        session_.viewDirty = true;
      }
  double uiBegan = threadMilliseconds();
  layer_.beginFrame();
  // Drawn first: among windows that focus does not raise, ImGui keeps the order in which they were drawn.
  if (!session_.hideUi) dragEdges(where, layer_.scale(), session_.preferences.sizes);
  viewport_.draw(session_, layer_, where.viewport);
  session_.accuracy.open = false;
  if (!session_.hideUi) drawPanels(session_, panels_, where);
  drawBanner(session_, where.viewport);
  drawMessages(session_, where.viewport);
  drawProgress(session_, where.viewport);
  drawHelp(session_, where.viewport);
  openDialog_.draw(session_);
  unsavedDialog_.draw(session_);
  builder_.announced();
  double uiMs = threadMilliseconds() - uiBegan;

  // Frames of the progress bar stay out of the timings, where the rebuild's own passes are being summed.
  Frame frame = busy ? context_.beginUntimed() : context_.begin(frameIndex_);
  if (!busy) frame.sampled(frameIndex_++, lastDraw_);
  if (!busy && session_.built && session_.viewDirty) {
    drawPictures(session_, frame);
    framesLeft_ = std::max(framesLeft_, 2);  // one more frame, for this one's times
  }
  uiBegan = threadMilliseconds();
  layer_.draw(frame, image_);
  uiMs += threadMilliseconds() - uiBegan;
  if (measuring_) options_.uiMilliseconds->push_back(uiMs);
  if (controls_) controls_->write();
  presenter_.present(frame, image_);
  --framesLeft_;
}

}  // namespace

void runWindow(Context& context, const WindowOptions& options) {
  Window(context, options).run();
}

}  // namespace irad
