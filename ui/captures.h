// What the dialog "Captures" shows (ui/captures_dialog.h): the output folder's captures and recordings, their pictures,
// and two of them compared. Files are read on a thread of its own, each once; pictures stay while the dialog is open.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "gi/captures.h"
#include "renderer/metrics.h"
#include "renderer/resources.h"
#include "ui/background_worker.h"

namespace irad {

struct Session;

class Captures {
 public:
  /// Of a PNG; neither image nor error: it has not been read yet.
  struct Picture {
    Image image;        ///< what screens show, made smaller
    std::string error;  ///< why there is none, with the file's name
  };
  /// Two pictures beside each other.
  struct Pair {
    std::array<CaptureEntry, 2> of;
    std::array<Picture, 2> pictures;
    std::optional<PictureMetrics> metrics;  ///< of the second against the first, linear
    std::string noMetrics;                  ///< why there are none; empty: they are, or are being measured
  };
  static constexpr uint32_t kThumbnail = 192, kLarge = 1024;  ///< pixels of a picture's longer side

  bool shown = false;   ///< the dialog is open
  bool listed = false;  ///< `list` is what the folder held when it was read
  CaptureList list;
  std::map<std::filesystem::path, Picture> pictures;  ///< thumbnails, by their files
  std::optional<Pair> pair;
  std::string said;  ///< what went wrong with something that the dialog has asked for

  // Requests.
  bool endPair = false;  ///< the pair is not shown any more (its pictures live until the frame is submitted)
  bool read = false;     ///< the list, anew
  std::optional<std::array<CaptureEntry, 2>> compare;  ///< two that have pictures
  std::optional<std::filesystem::path> replay;         ///< a manifest: the loop has asked what may be lost

  bool busy() const { return worker_.busy(); }  ///< files are being read
  /// Between frames: does what is asked for, of the captures in `folder`. True: there is something new to show.
  bool serve(Session& session, const std::filesystem::path& folder);

 private:
  void readList(Session& session, const std::filesystem::path& folder);
  void readPair(Session& session);
  BackgroundWorker worker_;
};

}  // namespace irad
