// The controls of the window by their names, for tests that click them wherever they lie.
//
// A control's name is the path of the IDs around it and its own label: "Settings/voxel.resolution", "Menu/File/Quit",
// "Unsaved changes/Cancel". Of a label the part after "###" counts, else the part before "##", else the part after it;
// where that is empty, the path is the name.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace irad {

class Controls {
 public:
  /// ImGui's context must be there.
  explicit Controls(std::filesystem::path file);
  ~Controls();
  Controls(const Controls&) = delete;

  /// Null except in tests: nobody asks for names.
  static Controls* current();
  void enter(std::string_view id);
  void leave();
  /// The item that ImGui has just been given. `on`: ticked, chosen, unfolded.
  void add(std::string_view label, bool on);
  /// Something that is drawn, not an item: where it can be taken with the mouse (screen pixels).
  void place(std::string_view label, bool on, glm::vec2 low, glm::vec2 high);
  /// What is said while the mouse rests in this area of ImGui's present window.
  void help(std::string_view text, glm::vec2 low, glm::vec2 high);

  /// Those of the frame that has been drawn, one per line: the control's rectangle, the part of the window that its
  /// region shows (x, y, width, height in pixels), 1 where it is on, 1 where it is disabled, and after a tab its name.
  /// "pointer" is the mouse, on while a button of it is pressed. The file is replaced as a whole, and so is FILE.help:
  /// for each control its name and, after a tab, what is said while the mouse rests on its middle, in one line.
  void write();

 private:
  struct Told {
    std::string name, line;
    const void* window;
    glm::vec2 middle;
  };
  struct Help {
    std::string text;
    const void* window;
    glm::vec2 low, high;
  };
  void tell(std::string_view label, bool on, bool disabled, glm::vec2 low, glm::vec2 high);
  std::string helpOf(const Told& told) const;
  std::filesystem::path file_;
  std::vector<std::string> path_;
  std::vector<Told> told_;
  std::vector<Help> helps_;
};

}  // namespace irad
