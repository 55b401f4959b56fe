#include "ui/window.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "gi/check/check.h"
#include "renderer/error.h"
#include "renderer/image_io.h"
#include "renderer/output_file.h"
#include "renderer/presenter.h"
#include "ui/bindings.h"
#include "ui/imgui_layer.h"
#include "ui/input.h"
#include "ui/overlay.h"
#include "ui/panel.h"
#include "ui/theme.h"

namespace irad {
namespace {

constexpr double kBusyInterval = 0.1;    ///< seconds between frames while a load or a rebuild runs
constexpr double kHiddenInterval = 0.1;  ///< seconds between looks whether a window without area has one again
constexpr int kFramesPerEvent = 3;       ///< ImGui needs a few to settle after an event
constexpr const char* kCancelled = "cancelled";

/// Every setting as a number, to see whether anything was edited.
std::vector<double> values(Settings settings) {
  std::vector<double> out;
  visit(settings, [&](auto&& member, const Meta&) {
    if constexpr (requires { member.value; })
      out.push_back(member.value);
    else
      out.push_back(static_cast<double>(member));
  });
  return out;
}

class Window {
 public:
  Window(Context& context, const WindowOptions& options);
  void run();

 private:
  void load(const std::filesystem::path& path);
  void open(const std::filesystem::path& path);
  void takeKeys();
  void act(Action action);
  void takeRequests();
  void applyEdits();
  void prepare(Pipeline& pipeline);
  void forgetTimes();
  void fly();
  void drawFrame();
  void drawPanels(const Layout& layout);
  void drawViewport(const Rect& where);
  void reloadShaders();
  void capture();
  void saveScreenshot();
  bool working() const;
  bool settled() const;
  void wait();
  bool progress(const char* stage, float fraction);

  Context& context_;
  const WindowOptions& options_;
  Session session_;
  Presenter presenter_;
  Input input_;
  ImGuiLayer layer_;
  std::vector<std::unique_ptr<Panel>> panels_ = makePanels();
  Image image_;  ///< the whole window
  glm::uvec2 viewport_{0};
  std::vector<double> applied_;  ///< values() of what the pipeline has
  bool loadedLambertian_ = false;
  bool stale_ = false;              ///< shaders have changed that made what the pipeline holds
  bool visible_ = true;             ///< the last frame had something to be drawn on
  Redo shownNext_ = Redo::Nothing;  ///< what the last frame announced
  int framesLeft_ = kFramesPerEvent;
  uint32_t settledFrames_ = 0;
  uint64_t frameIndex_ = 0;
  double lastDraw_ = 0, workBegan_ = 0;
};

Window::Window(Context& context, const WindowOptions& options)
    : context_(context),
      options_(options),
      session_(context),
      presenter_("irad", static_cast<int>(options.size.x), static_cast<int>(options.size.y)),
      input_(presenter_.window()),
      layer_(context, presenter_.window()) {
  presenter_.attach(context);
  session_.edited = options.settings;
  session_.defaults = options.defaults;
  session_.view = options.view;
}

void Window::run() {
  load(options_.scene);
  if (!options_.camera.empty() && session_.pipeline) {
    const std::vector<Camera>& cameras = session_.pipeline->scene().cameras;
    const auto named =
        std::find_if(cameras.begin(), cameras.end(), [&](const Camera& c) { return c.name == options_.camera; });
    if (named == cameras.end())
      throw UsageError(fmt::format("--camera {}: the scene has no camera of that name", options_.camera));
    session_.useSceneCamera(static_cast<int>(named - cameras.begin()));
  }
  while (!session_.quit && !glfwWindowShouldClose(presenter_.window())) {
    wait();
    takeKeys();
    try {
      takeRequests();
      applyEdits();
      fly();
      if (framesLeft_ > 0 || !settled() || options_.exitAfter > 0) drawFrame();
    } catch (const Error& error) {
      // A frame that failed before it was drawn would fail again at once: stop, unless a smaller picture may do.
      if (session_.halted || !session_.pipeline) throw;
      session_.halted = true;
      session_.error(error.what());
    }
    if (options_.exitAfter > 0 && settled() && ++settledFrames_ >= options_.exitAfter) break;
  }
  if (!options_.screenshot.empty()) saveScreenshot();
}

/// Something is to be done that needs no frame.
bool Window::working() const {
  return session_.work || session_.openScene || session_.capture || session_.reloadShaders || session_.rebuild ||
         stale_ || (session_.pipeline && !session_.halted && !session_.paused && !session_.asleep());
}

bool Window::settled() const {
  return !working() && !session_.viewDirty && session_.next == Redo::Nothing;
}

/// Sleeps until there is an event, when nothing is left to do: an idle window does no work on either processor. What
/// wakes it and is none (the display answering a presentation) lets it sleep again.
void Window::wait() {
  const bool hidden = !visible_ && !working();
  const bool idle = settled() && framesLeft_ <= 0 && !input_.flying() && options_.exitAfter == 0;
  const bool blinks = idle && ImGui::GetIO().WantTextInput;  // the text cursor
  if (hidden)
    glfwWaitEventsTimeout(kHiddenInterval);
  else if (!idle)
    glfwPollEvents();
  else if (blinks)
    glfwWaitEventsTimeout(0.4);
  else
    glfwWaitEvents();
  if (input_.takeEvent())
    framesLeft_ = kFramesPerEvent;
  else if (blinks || hidden)
    framesLeft_ = 1;
}

void Window::takeKeys() {
  for (const std::filesystem::path& path : input_.takeDrops()) session_.openScene = path;
  const std::vector<int> presses = input_.takePresses();
  if (ImGui::GetIO().WantTextInput) return;
  for (const int key : presses) {
    for (const Binding& binding : bindings())
      if (binding.key == key) act(binding.action);
    const auto number = static_cast<size_t>(key - GLFW_KEY_1);
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9 && number < views().size()) {
      session_.view = views()[number].view;
      session_.viewDirty = true;
    }
  }
}

void Window::act(Action action) {
  switch (action) {
    case Action::None:
      break;
    case Action::Help:
      session_.showHelp = !session_.showHelp;
      break;
    case Action::HideUi:
      session_.hideUi = !session_.hideUi;
      break;
    case Action::ReloadShaders:
      session_.reloadShaders = true;
      break;
    case Action::Capture:
      session_.capture = true;
      break;
    case Action::Pause:
      session_.paused = !session_.paused;
      break;
    case Action::NextCamera:
      if (session_.pipeline)
        session_.useSceneCamera((session_.sceneCamera + 1) %
                                static_cast<int>(session_.pipeline->scene().cameras.size()));
      break;
    case Action::Quit:
      session_.quit = true;
      if (session_.work) session_.work->cancel = true;
      break;
  }
}

void Window::takeRequests() {
  if (std::exchange(session_.reloadShaders, false)) reloadShaders();
  if (std::exchange(session_.capture, false)) capture();
  if (std::exchange(session_.rebuild, false)) session_.halted = false;
  if (session_.openScene) open(*std::exchange(session_.openScene, std::nullopt));
}

void Window::open(const std::filesystem::path& path) {
  try {
    load(path);
  } catch (const Error& error) {
    session_.error(error.what());
    framesLeft_ = kFramesPerEvent;
  }
}

/// Loads and prepares beside the scene that is shown, and replaces it only when both have succeeded.
void Window::load(const std::filesystem::path& path) {
  session_.work = Work{.what = "Loading " + path.filename().string(), .stage = "", .fraction = 0};
  workBegan_ = glfwGetTime();
  try {
    LoadOptions load;
    load.lambertian = session_.edited.lambertian;
    load.progress = [this](float fraction, const char* step) {
      if (!progress(step, fraction)) throw WorkError(kCancelled);
    };
    Scene scene = openScene(path, load);
    auto pipeline = std::make_unique<Pipeline>(context_, std::move(scene), session_.edited);
    prepare(*pipeline);
    const bool sameScene = session_.pipeline && session_.pipeline->scene().path == pipeline->scene().path;
    session_.pipeline = std::move(pipeline);
    applied_ = values(session_.pipeline->settings());
    loadedLambertian_ = session_.pipeline->settings().lambertian;
    session_.halted = false;
    if (!sameScene) session_.useSceneCamera(0);
    glfwSetWindowTitle(presenter_.window(), fmt::format("irad \u2014 {}", path.filename().string()).c_str());
  } catch (const Error&) {
    forgetTimes();
    const bool cancelled = session_.work->cancel;
    session_.work.reset();
    if (session_.pipeline) session_.edited.lambertian = loadedLambertian_;
    if (!cancelled) throw;
    session_.note(fmt::format("{}: loading was cancelled", path.filename().string()));
  }
  session_.work.reset();
  framesLeft_ = kFramesPerEvent;
}

/// Hands edits to the pipeline, redoes what they call for, and lets the solver go on until it sleeps. What will be
/// redone is on screen for a frame before it starts, and while the mouse still holds the widget.
void Window::applyEdits() {
  if (!session_.pipeline) return;
  Pipeline& pipeline = *session_.pipeline;
  if (values(session_.edited) != applied_) {
    const bool reload = session_.edited.lambertian != loadedLambertian_;
    const Redo redo = reload ? Redo::Voxels : difference(pipeline.settings(), session_.edited);
    session_.next = redo;
    if (redo < Redo::Shade && (shownNext_ != redo || ImGui::IsAnyItemActive())) return;
    session_.next = Redo::Nothing;
    if (reload) return open(std::filesystem::path(pipeline.scene().path));
    pipeline.set(session_.edited);
    applied_ = values(session_.edited);
    session_.viewDirty = true;
    session_.halted = false;
    if (redo < Redo::Scatter) {
      session_.solves.clear();
      session_.sweepsSinceWake = 0;
    }
    if (redo >= Redo::Shade && !session_.asleep() && session_.paused) return;
  } else {
    session_.next = Redo::Nothing;
    if (session_.paused && session_.built && !stale_) return;
  }
  stale_ = false;
  if (session_.halted || (session_.built && pipeline.asleep())) return;
  session_.work = Work{.what = "Rebuilding", .stage = "", .fraction = 0};
  workBegan_ = glfwGetTime();
  try {
    prepare(pipeline);
  } catch (const Error& error) {
    session_.halted = true;
    forgetTimes();
    if (!session_.work->cancel)
      session_.error(error.what());
    else if (!session_.quit)
      session_.note("The rebuild was cancelled; the picture shows the old state.");
  }
  session_.work.reset();
}

/// What given-up work has measured is no frame's time.
void Window::forgetTimes() {
  context_.finish();
  context_.timings.forget();
}

void Window::prepare(Pipeline& pipeline) {
  pipeline.prepare([this](const char* stage, float fraction) { return progress(stage, fraction); },
                   session_.paused ? 1 : pipeline.settings().solver.sweepsPerFrame);
  if (&pipeline != session_.pipeline.get()) {
    session_.solves.clear();
    session_.sweepsSinceWake = 0;
  }
  const FacetList& facets = pipeline.facets();
  const SolveReport& report = pipeline.lighting().report;
  session_.built = Built{.dims = facets.grid.dims,
                         .facets = facets.count,
                         .solidVoxels = facets.solidVoxels,
                         .clampedAlbedo = facets.clampedAlbedo,
                         .edge = facets.grid.edge,
                         .solve = report,
                         .findings = pipeline.findings(),
                         .tolerance = pipeline.settings().solver.tolerance};
  session_.solves.push_back({report.sweeps, report.residual, report.bound});
  if (session_.solves.size() > 400) session_.solves.pop_front();
  session_.sweepsSinceWake += report.sweeps;
  session_.viewDirty = true;
}

/// Called in the middle of a load or a rebuild: events, and now and then a frame. False: cancelled.
bool Window::progress(const char* stage, float fraction) {
  session_.work->stage = stage;
  session_.work->fraction = std::clamp(fraction, 0.0f, 1.0f);
  const double now = glfwGetTime();
  if (now - std::max(lastDraw_, workBegan_) < kBusyInterval) return !session_.work->cancel;
  glfwPollEvents();
  takeKeys();
  if (glfwWindowShouldClose(presenter_.window())) session_.work->cancel = session_.quit = true;
  drawFrame();
  return !session_.work->cancel;
}

void Window::fly() {
  const glm::vec3 seconds = input_.takeMovement();
  if (ImGui::GetIO().WantTextInput || seconds == glm::vec3(0.0f)) return;
  session_.camera.move(seconds, input_.shift() ? 4.0f : input_.control() ? 0.25f : 1.0f);
  session_.viewDirty = true;
}

void Window::drawFrame() {
  const glm::uvec2 size = presenter_.framebufferSize();
  if (size.x == 0 || size.y == 0) framesLeft_ = 0;  // iconified: until the next event
  visible_ = presenter_.acquire();
  if (!visible_) return;
  const auto began = std::chrono::steady_clock::now();
  lastDraw_ = glfwGetTime();
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

  const Layout where = layout(size, layer_.scale(), session_.hideUi);
  viewport_ = glm::max(glm::uvec2(where.viewport.size), glm::uvec2(1));
  // While a rebuild runs the last picture is shown, stretched if need be.
  if (!busy && session_.built && session_.targets.size != viewport_) {
    session_.targets = Targets(context_, viewport_);
    session_.viewDirty = true;
  }
  layer_.beginFrame();
  drawViewport(where.viewport);
  if (!session_.hideUi) drawPanels(where);
  drawBanner(session_, where.viewport);
  drawMessages(session_, where.viewport);
  drawProgress(session_, where.viewport);
  drawHelp(session_, where.viewport);
  shownNext_ = session_.next;

  // Frames of the progress bar stay out of the timings: the rebuild's own passes are being summed there.
  Frame frame = busy ? context_.beginUntimed() : context_.begin(frameIndex_);
  if (!busy) frame.sampled(frameIndex_++, began);
  if (!busy && session_.built && session_.viewDirty) {
    session_.pipeline->render(frame, session_.camera.camera(), session_.view, session_.targets);
    session_.viewDirty = false;
    framesLeft_ = std::max(framesLeft_, 2);  // one more frame, for this one's times
  }
  layer_.draw(frame, image_);
  presenter_.present(frame, image_);
  --framesLeft_;
}

void Window::drawPanels(const Layout& layout) {
  drawBar(session_, layout.bar);
  const std::pair<Region, Rect> tiles[] = {
      {Region::Left, layout.left}, {Region::Right, layout.right}, {Region::Bottom, layout.bottom}};
  for (const auto& [region, rect] : tiles) {
    beginTile(region == Region::Left ? "##left" : region == Region::Right ? "##right" : "##bottom", rect);
    for (const auto& panel : panels_) {
      if (panel->region() != region) continue;
      ImGui::PushID(panel->title());
      bool open = true;
      if (region != Region::Bottom) {  // the strip is low: its table begins at once
        pushHeadingFont();
        open = ImGui::CollapsingHeader(panel->title(), ImGuiTreeNodeFlags_DefaultOpen);
        ImGui::PopFont();
      }
      if (open) panel->draw(session_);
      ImGui::PopID();
    }
    endTile();
  }
}

void Window::drawViewport(const Rect& where) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  beginTile("##viewport", where, /*filled=*/false, /*scrolls=*/false);
  ImGui::PopStyleVar(2);
  const ImVec2 size{std::max(where.size.x, 1.0f), std::max(where.size.y, 1.0f)};
  if (session_.targets.display) {
    ImGui::Image(layer_.texture(session_.targets.display), size);
    ImGui::SetCursorPos({0, 0});
  }
  ImGui::InvisibleButton("##look", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  const ImGuiIO& io = ImGui::GetIO();
  // What the mouse moved before it was pressed is no drag, also where a slow frame sees both at once.
  if (ImGui::IsItemActive() && !ImGui::IsItemActivated() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    session_.camera.look(io.MouseDelta.x, io.MouseDelta.y);
    session_.viewDirty = true;
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) session_.camera.changeSpeed(io.MouseWheel);
  endTile();
}

void Window::reloadShaders() {
  if (options_.shaders.empty())
    return session_.error("F5: the folder shaders/ was not found; the built-in shaders stay");
  const ShaderReload reload = context_.shaders.reload(options_.shaders);
  if (!reload.errors.empty()) return session_.error("The old shaders stay in use.\n" + reload.errors);
  if (reload.changed.empty()) return session_.note("F5: no shader has changed");
  // Whatever a changed shader had a part in is made anew.
  const auto changedIn = [&](std::string_view folder) {
    return std::any_of(reload.changed.begin(), reload.changed.end(),
                       [&](const std::string& name) { return name.starts_with(folder); });
  };
  const bool build = changedIn("gi/"), shadows = changedIn("forward/");  // shadow maps are drawn by depth.vert
  if (session_.pipeline && build) session_.pipeline->invalidate(Redo::Voxels);
  if (session_.pipeline && shadows) session_.pipeline->lightsChanged();
  if (build || shadows) {
    stale_ = session_.pipeline != nullptr;
    session_.halted = false;
    session_.solves.clear();
    session_.sweepsSinceWake = 0;
  }
  session_.viewDirty = true;
  session_.note(fmt::format("Compiled again: {}", fmt::join(reload.changed, ", ")));
}

/// The view as shown, and its light before exposure, under the first free number.
void Window::capture() {
  if (!session_.built || !session_.targets.display) return;
  const char* view = "view";
  for (const ViewInfo& info : views())
    if (info.view == session_.view) view = info.name;
  try {
    makeFolder(options_.captures);
    std::filesystem::path stem;
    for (int number = 1;; ++number) {
      stem =
          options_.captures / fmt::format("{}.{}.{:03}", session_.pipeline->scene().path.stem().string(), view, number);
      if (!std::filesystem::exists(stem.string() + ".png")) break;
    }
    const std::vector<std::byte> display = download(context_, session_.targets.display);
    const std::vector<std::byte> linear = download(context_, session_.targets.linear);
    const glm::uvec2 size = session_.targets.size;
    const size_t pixels = static_cast<size_t>(size.x) * size.y;
    const auto png = writeDisplay(stem.string(), size, {reinterpret_cast<const glm::u8vec4*>(display.data()), pixels});
    const auto exr = writeLinear(stem.string(), size, {reinterpret_cast<const glm::vec4*>(linear.data()), pixels});
    session_.note(fmt::format("Saved {} and {}", png.string(), exr.filename().string()));
  } catch (const Error& error) {
    session_.error(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    session_.error(error.what());
  }
}

void Window::saveScreenshot() {
  if (!image_) return;
  const std::vector<std::byte> bytes = download(context_, image_);
  std::filesystem::path stem = options_.screenshot;
  stem.replace_extension();
  writeDisplay(stem, {image_.desc.width, image_.desc.height},
               {reinterpret_cast<const glm::u8vec4*>(bytes.data()), bytes.size() / sizeof(glm::u8vec4)});
}

}  // namespace

void runWindow(Context& context, const WindowOptions& options) {
  Window(context, options).run();
}

}  // namespace irad
