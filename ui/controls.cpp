#include "ui/controls.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <fstream>
#include <glm/vector_relational.hpp>

namespace irad {
namespace {

std::string_view controlName(std::string_view label) {
  if (const size_t at = label.find("###"); at != label.npos) return label.substr(at + 3);
  const size_t at = label.find("##");
  if (at == 0) return label.substr(2);
  return label.substr(0, at);
}

}  // namespace

Controls::Controls(std::filesystem::path file) : file_(std::move(file)) {
  ImGui::GetIO().UserData = this;
}

Controls::~Controls() {
  ImGui::GetIO().UserData = nullptr;
}

Controls* Controls::current() {
  return static_cast<Controls*>(ImGui::GetIO().UserData);
}

void Controls::enter(std::string_view id) {
  path_.emplace_back(controlName(id));
}

void Controls::leave() {
  path_.pop_back();
}

void Controls::add(std::string_view label, bool on) {
  const bool disabled = (ImGui::GetCurrentContext()->CurrentItemFlags & ImGuiItemFlags_Disabled) != 0;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  tell(label, on, disabled, {low.x, low.y}, {high.x, high.y});
}

void Controls::place(std::string_view label, bool on, glm::vec2 low, glm::vec2 high) {
  tell(label, on, /*disabled=*/false, low, high);
}

void Controls::tell(std::string_view label, bool on, bool disabled, glm::vec2 low, glm::vec2 high) {
  const ImGuiWindow& window = *ImGui::GetCurrentWindowRead();
  if (window.SkipItems || window.Hidden) return;  // hidden: its first frame, in which it finds its size and place
  std::string name;
  const auto add = [&](std::string_view part) {
    if (!part.empty()) name += fmt::format("{}{}", name.empty() ? "" : "/", part);
  };
  for (const std::string& part : path_) add(part);
  add(controlName(label));
  const auto rect = [](glm::vec2 from, glm::vec2 to) {
    return fmt::format("{:.0f} {:.0f} {:.0f} {:.0f} ", from.x, from.y, to.x - from.x, to.y - from.y);
  };
  const ImRect& clip = window.ClipRect;
  std::string line = rect(low, high) + rect({clip.Min.x, clip.Min.y}, {clip.Max.x, clip.Max.y}) +
                     fmt::format("{:d} {:d}", on, disabled);
  told_.push_back({std::move(name), std::move(line), &window, 0.5f * (low + high)});
}

void Controls::help(std::string_view text, glm::vec2 low, glm::vec2 high) {
  helps_.push_back({std::string(text), ImGui::GetCurrentWindowRead(), low, high});
}

std::string Controls::helpOf(const Told& told) const {
  std::string text;
  for (const Help& help : helps_)
    if (help.window == told.window && glm::all(glm::lessThanEqual(help.low, told.middle)) &&
        glm::all(glm::lessThan(told.middle, help.high)))
      text += (text.empty() ? "" : " | ") + help.text;
  std::ranges::replace(text, '\n', ' ');
  return text;
}

void Controls::write() {
  std::string lines, helps;
  for (const Told& told : told_) {
    lines += fmt::format("{}\t{}\n", told.line, told.name);
    helps += fmt::format("{}\t{}\n", told.name, helpOf(told));
  }
  // Where the mouse was and whether it was pressed in this frame, so that a test knows when it has been seen.
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsMousePosValid())
    lines += fmt::format("{:.0f} {:.0f} 0 0 0 0 0 0 {:d} 0\tpointer\n", io.MousePos.x, io.MousePos.y,
                         ImGui::IsAnyMouseDown());
  const auto replace = [](std::filesystem::path file, const std::string& content) {
    std::filesystem::path whole = file;
    whole += ".part";
    std::ofstream(whole) << content;
    std::filesystem::rename(whole, file);
  };
  std::filesystem::path beside = file_;
  replace(beside += ".help", helps);
  replace(file_, lines);
  told_.clear();
  helps_.clear();
  path_.clear();  // an error may have ended the frame within a panel
}

}  // namespace irad
