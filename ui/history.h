// Undo and redo: the states that the user's edits have led through, with a name for the step to each. Pure: it is told
// the state of every frame, and finds the steps by ==.
#pragma once

#include <string>
#include <vector>

#include "ui/edit_state.h"

namespace irad {

class History {
 public:
  static constexpr size_t kMost = 200;  ///< steps that are remembered; the oldest go first

  struct Step {
    std::string name;  ///< of the step that led here
    EditState state;
    bool flight = false;
  };

  /// Another scene: it begins with the next state that it sees.
  void clear();
  /// The state after a frame. What differs from the last becomes a step once it is not `held`: while the mouse drags a
  /// value, a field is typed into or a key flies, the edit goes on. Flights that follow each other are one step. Where
  /// one looks from and at which view is no reason to forget what may be redone: it changes with the present step then.
  void see(const EditState& now, bool held);
  /// The same of a state that something was given up for, such as a rebuild: a step back where it leads to an earlier
  /// state. Never held.
  void seeReturned(const EditState& now);
  /// What the next step will be called, in place of whatChanged(): "preset fast". Forgotten where nothing changes.
  void call(std::string name) { called_ = std::move(name); }

  /// Undone ones too; the first one is the beginning.
  const std::vector<Step>& steps() const { return steps_; }
  size_t at() const { return at_; }  ///< the step whose state is shown
  bool canUndo() const { return at_ > 0; }
  bool canRedo() const { return at_ + 1 < steps_.size(); }
  /// The state of a step, which is the present one from now on: steps after it can be redone.
  const EditState& go(size_t step);

 private:
  void reshape(const EditState& now);
  void push(const EditState& now, bool flight);

  std::vector<Step> steps_;
  size_t at_ = 0;
  std::string called_;
};

}  // namespace irad
