#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "ui/autosave_dialog.h"
#include "ui/bindings.h"
#include "ui/capture.h"
#include "ui/comparison.h"
#include "ui/glossary.h"
#include "ui/imgui.h"
#include "ui/missing_input.h"
#include "ui/open_folder.h"
#include "ui/outline.h"
#include "ui/overlay.h"
#include "ui/pictures.h"
#include "ui/theme.h"
#include "ui/window_impl.h"

namespace irad {
namespace {

constexpr std::chrono::milliseconds kBusyInterval{100};  ///< between frames while a load or a rebuild runs
constexpr double kHiddenInterval = 0.1;     ///< seconds between looks whether a window without area has one again
constexpr double kWatchInterval = 0.2;      ///< seconds between frames while all that goes on is a reference
constexpr double kWriteInterval = 0.02;     ///< seconds between looks whether a file of the window's own is written
constexpr double kSameInterval = 1.0 / 60;  ///< seconds between frames while nothing comes that would be seen

/// CPU time of this thread, ms: what drivers and other programs do meanwhile is not counted.
double threadMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Window::Window(Context& context, const WindowOptions& options)
    : context_(context),
      options_(options),
      session_(context),
      presenter_("irad", static_cast<int>(options.size.x), static_cast<int>(options.size.y)),
      input_(presenter_.window()),
      layer_(context, presenter_.window()),
      builder_(context, session_, [this] { breathe(); }),
      unsavedDialog_(options.captures),
      keeper_(options.preferences, writer_) {
  presenter_.attach(context);
  context.bridgeVariants(true);
  session_.edited = session_.saved = options.settings;
  session_.defaults = options.defaults;
  session_.view = options.view;
  if (options.reference) session_.reference = std::make_shared<const ReferencePicture>(*options.reference);
  session_.load = options.load;
  session_.builtIn = options.builtIn;
  session_.exposes = options.exposes;
  session_.underRenderDoc = renderDoc_.has_value();
  session_.presets = options.presets;
  if (!options.controls.empty()) controls_.emplace(options.controls);
  readPreferences();
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
  offerFound();
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
  if (session_.quit) keeper_.end();  // saved, or discarded
  if (!options_.screenshot.empty() && image_) saveScreenshot(context_, image_, options_.screenshot);
}

/// Once the light is at rest, and then what is chosen is shown, keeps frames coming as somebody's hands do: a picture,
/// and as many frames of panels alone as follow an event. True when enough of them have been measured.
bool Window::measured() {
  if (!measuring_ && settled()) {
    measuring_ = choseAll_;
    if (!std::exchange(choseAll_, true)) chooseAll();
  }
  if (measuring_ && framesLeft_ <= 0) {
    session_.viewDirty = true;
    framesLeft_ = 1 + kFramesPerEvent;
  }
  return options_.uiMilliseconds->size() >= options_.measuredFrames;
}

/// Every panel unfolded, and what there is to choose in them chosen: the first light; facet, material and object in the
/// middle of the picture.
void Window::chooseAll() {
  session_.preferences.folded.clear();
  if (!session_.edits.lights.empty()) session_.edits.selected = 0;
  session_.inspection.pick = Inspection::Pick{.pixel = session_.targets.size / 2u};
  framesLeft_ = kFramesPerEvent;
}

/// There is something to do that needs no frame.
bool Window::working() const {
  return session_.work || session_.openScene || session_.openPicture || session_.capture || session_.captureAll ||
         session_.captureFrame || session_.captures.replay || session_.answer || session_.reloadShaders ||
         session_.rebuild || session_.compare || session_.inspection.wanted() || session_.accuracy.measuring() ||
         builder_.stale() || (session_.pipeline && !session_.halted && !session_.paused && !session_.allAsleep());
}

bool Window::settled() const {
  // What waits for a slider to be let go, or for a number to be typed to its end, takes an event to go on.
  const bool due = session_.next != Redo::Nothing && !session_.pending && !ImGui::IsAnyItemActive();
  // Variants that have come in the last frame call for a picture, which is not asked for yet.
  return !working() && !session_.viewDirty && !due && !compiling_ && context_.variantsCompiling() == 0;
}

/// Sleeps until there is an event, when nothing is left to do: an idle window does no work on either processor.
/// Wake-ups that bring none (the display answering a presentation) let it sleep again.
void Window::wait() {
  const bool hidden = !visible_ && !working();
  const bool typing = ImGui::GetIO().WantTextInput || session_.dialogOpen();  // keys that are held fly nowhere
  const bool idle = settled() && framesLeft_ <= 0 && (typing || !input_.flying()) && options_.exitAfter == 0;
  const bool watches = idle && (session_.accuracy.tracingNow() || session_.captures.busy());  // their progress
  const auto message = session_.nextMessageEnds();
  if (hidden)
    glfwWaitEventsTimeout(kHiddenInterval);
  else if (!idle && same_)
    glfwWaitEventsTimeout(kSameInterval);
  else if (!idle)
    glfwPollEvents();
  else if (watches)
    glfwWaitEventsTimeout(kWatchInterval);
  else if (writer_.busy())
    glfwWaitEventsTimeout(kWriteInterval);
  else if (message)
    glfwWaitEventsTimeout(std::max(std::chrono::duration<double>(*message - Clock::now()).count(), 0.01));
  else
    glfwWaitEvents();
  if (input_.takeEvent() || (message && Clock::now() >= *message))
    framesLeft_ = kFramesPerEvent;
  else if (watches || hidden)
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
    // What the mouse holds would be edited on from where it has been taken back to.
    const bool steps = binding != all.end() && (binding->action == Action::Undo || binding->action == Action::Redo);
    if (steps && ImGui::IsAnyItemActive()) continue;
    if (binding != all.end()) session_.act(binding->action);
    const auto number = static_cast<size_t>(press.key - GLFW_KEY_1);
    if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9 && number < views().size()) {
      session_.view = views()[number].view;
      session_.viewDirty = true;
    }
  }
}

void Window::takeRequests() {
  if (writer_.take()) framesLeft_ = std::max(framesLeft_, 2);  // it may have said that it failed
  savePreferences();
  if (const auto answer = std::exchange(session_.answer, std::nullopt)) answerOffer(*answer);
  if (std::exchange(session_.reloadShaders, false)) builder_.reloadShaders(options_.shaders);
  serveRecorder(session_, options_.captures, options_.program);
  if (session_.openFolder) {
    try {
      openFolder(*std::exchange(session_.openFolder, std::nullopt));
    } catch (const Error& error) {
      if (session_.captures.shown)
        session_.captures.said = error.what();  // a message would lie under the dialog
      else
        session_.error(error.what());
    }
    framesLeft_ = kFramesPerEvent;
  }
  if (session_.captures.serve(session_, options_.captures)) framesLeft_ = kFramesPerEvent;
  if (session_.captures.replay) replay(*std::exchange(session_.captures.replay, std::nullopt));
  if (session_.openPicture) builder_.openPicture(*std::exchange(session_.openPicture, std::nullopt));
  if (std::exchange(session_.darken, false)) builder_.darken();
  if (std::exchange(session_.rebuild, false)) session_.halted = false;
  if (const std::optional<bool> compare = std::exchange(session_.compare, std::nullopt)) {
    if (*compare)
      builder_.compare();
    else
      session_.comparison.reset();
  }
  if (session_.comparison && !session_.viewDirty && measureComparison(context_, session_))
    framesLeft_ = kFramesPerEvent;
  if (session_.openScene) open(*std::exchange(session_.openScene, std::nullopt));
  keeper_.keep(session_);
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
    session_.note(fmt::format("RenderDoc saved {}", file.string()),
                  std::filesystem::absolute(file).lexically_normal().parent_path());
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
  if (std::exchange(historyOf_, path) != path) session_.history.clear();
  const std::string file = session_.pipeline->scene().path.filename().string();
  glfwSetWindowTitle(presenter_.window(), fmt::format("irad \u2014 {}", file).c_str());
}

void Window::open(const std::filesystem::path& path) {
  try {
    builder_.load(path);
    sceneOpened();
  } catch (const Error& error) {
    session_.openFailed(error.what());
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
  // What is drawn over the picture goes by the camera that keys have left for this frame's picture.
  if (!busy && session_.built && session_.viewDirty) session_.shown = session_.camera.camera();
  // The last frame before the sleep shows the times of all others: only it waits for them.
  if (framesLeft_ <= 1 && settled())
    context_.finish();
  else
    context_.collect();
  const bool resized = image_.desc.width != size.x || image_.desc.height != size.y;
  if (resized)
    image_ = Image(context_.device, ImageDesc{.name = "window",
                                              .subsystem = Subsystem::Ui,
                                              .format = VK_FORMAT_R8G8B8A8_UNORM,
                                              .width = size.x,
                                              .height = size.y,
                                              .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
  float contentScale = 1, ignored = 1;
  glfwGetWindowContentScale(presenter_.window(), &contentScale, &ignored);
  session_.scale = session_.preferences.scale > 0 ? session_.preferences.scale : options_.scale;
  layer_.setScale(contentScale * session_.scale);

  const Layout where =
      layout(size, layer_.scale(), session_.filling(), session_.preferences.sizes, session_.preferences.folding());
  const glm::uvec2 picture = glm::max(glm::uvec2(where.viewport.size), glm::uvec2(1));
  // While a rebuild runs the last picture is shown, stretched if need be.
  if (!busy && session_.built)
    for (Side* side : session_.sides())
      if (side->targets.size != picture) {
        side->targets = Targets(context_, picture);
        session_.viewDirty = true;
      }
  if (!busy) session_.pointing.take(session_);
  const bool due = session_.viewDirty;
  layer_.takeInput();
  if (measuring_) context_.device.waitIdle();  // a CPU device's threads would share the core with this one
  double uiBegan = threadMilliseconds();
  layer_.beginFrame();
  // Drawn first: among windows that focus does not raise, ImGui keeps the order in which they were drawn.
  const Filling filling = session_.filling();
  if (filling == Filling::Panels)
    drawEdges(where, layer_.scale(), session_.preferences.sizes, session_.preferences.folded);
  viewport_.draw(session_, layer_, where.viewport);
  session_.accuracy.open = false;
  session_.histogram.wanted = false;
  if (filling != Filling::PictureAlone) drawPanels(session_, panels_, where);
  if (filling != Filling::Panels) drawFrameTime(session_, where.viewport);
  drawBanner(session_, where.viewport);
  Rect above = where.viewport;  // the status line
  if (!session_.hideUi) above.size.y = std::max(above.size.y - statusHeight(above.size.x), 1.0f);
  drawMessages(session_, above);
  drawProgress(session_, where.viewport);
  const Rect below{{0, where.bar.size.y}, glm::vec2(size) - glm::vec2(0, where.bar.size.y)};
  drawHelp(session_, below);
  openDialog_.draw(session_);
  capturesDialog_.draw(session_, layer_);
  unsavedDialog_.draw(session_);
  drawAutosaveDialog(session_);
  drawMissingInput(session_, where.viewport);
  drawGlossary(session_, below);
  builder_.announced();
  session_.seeEdits(/*held=*/ImGui::IsAnyItemActive() || input_.flying());
  keeper_.keep(session_);
  double uiMs = threadMilliseconds() - uiBegan;

  // Frames that draw nothing but panels stay out of the timings: they say nothing of the method, and while a rebuild
  // runs its own passes are being summed.
  // Panels come after what lies over the picture: of a camera that they have just moved the picture comes with the next
  // frame, and its handles with it.
  const bool current = due || session_.camera.camera() == session_.shown;
  const bool pictured = !busy && session_.built && session_.viewDirty && current;
  Frame frame = pictured ? context_.begin(frameIndex_) : context_.beginUntimed();
  if (pictured) {
    frame.sampled(frameIndex_++, lastDraw_);
    drawPictures(session_, frame);
    framesLeft_ = std::max(framesLeft_, 2);  // one more frame, for this one's times
  }
  if (!busy && session_.built) {
    drawOutline(session_, frame, layer_.scale());
    session_.pointing.record(session_, frame);
    session_.histogram.record(session_, frame);
  }
  uiBegan = threadMilliseconds();
  // Of three frames that an event brings, most would show what is there: triangles that are the same, of images in
  // which nothing has been drawn since.
  const bool others = layer_.endFrame(), lost = input_.takeRefresh(),
             counts = options_.exitAfter + options_.measuredFrames > 0;
  same_ = !others && !lost && !counts && !resized && !pictured && shownAt_ == drawnSoFar();
  if (!same_) layer_.draw(frame, image_);
  uiMs += threadMilliseconds() - uiBegan;
  if (measuring_) options_.uiMilliseconds->push_back(uiMs);
  if (controls_) controls_->write();
  if (same_)
    frame.submit();
  else
    presenter_.present(frame, image_);
  shownAt_ = drawnSoFar();
  --framesLeft_;
}

/// While it stays as it is, nothing is drawn into any image, and the window shows what it was given last.
std::array<uint64_t, 5> Window::drawnSoFar() const {
  const Counters all = context_.counters();
  return {all.dispatches, all.draws, all.submissions, all.images, presenter_.rebuilds()};
}

void runWindow(Context& context, const WindowOptions& options) {
  Window(context, options).run();
}

}  // namespace irad
