// What is under the mouse: its pixel of the picture, read back with the frames that are drawn, one late, and what the
// scene has there. The window's loop records and takes; the overlay shows it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gi/views/views.h"
#include "ui/zoom.h"

namespace irad {

class Frame;
class Pipeline;
struct Session;
struct Side;

class Pointing {
 public:
  Pointing();
  ~Pointing();
  Pointing(const Pointing&) = delete;

  /// A pixel, and of which of the pictures that share the viewport.
  struct Over {
    glm::uvec2 pixel{0};
    bool other = false;      ///< of the side that is not edited
    bool reference = false;  ///< of the reference, beside the picture
    bool operator==(const Over&) const = default;
  };
  /// Under the mouse, as of this frame; none: the mouse is elsewhere.
  std::optional<Over> over;
  /// The pixels that are shown so large that their values can be read in them; no size: none.
  struct Region {
    glm::uvec2 corner{0}, size{0};
    bool operator==(const Region&) const = default;
  };
  Region large;
  Zoom zoom;

  /// Of a pixel, in words.
  struct Reading {
    glm::uvec2 pixel{0};
    std::string value;  ///< with its unit
    std::string material;
    std::optional<uint32_t> facet;
    std::optional<glm::uvec3> voxel;
  };
  std::optional<Reading> reading;  ///< of the pixel that was under the mouse lately
  std::vector<glm::vec4> values;   ///< of the region that was `large` lately, row by row
  Region valuesOf;

  /// Asks for the pixel, once for each that the mouse is over and each picture; after the frame's picture was drawn.
  void record(Session& session, Frame& frame);
  /// Makes a reading of what has come back. True where it did.
  bool take(Session& session);

 private:
  struct Known;
  const Known& known(Session& session, const Side& side, bool other);
  void read(Session& session);

  struct Asked {
    Over over;
    uint64_t picture;
    bool operator==(const Asked&) const = default;
  };
  std::optional<Asked> asked_;
  struct Texels {
    Over over;
    View view = 0;
    bool difference = false;
    bool surfaces = false;  ///< depth and normal are the picture's
    glm::vec4 value{0};
    float depth = 0;
    uint64_t geometric = 0;
  };
  Texels texels_;
  bool fresh_ = false;  ///< texels_ have come back
  struct AskedRegion {
    Region region;
    uint64_t picture;
    bool operator==(const AskedRegion&) const = default;
  };
  std::optional<AskedRegion> askedRegion_;
  std::unique_ptr<Known> known_[2];  ///< of the edited side, and the other
};

/// The value of a pixel of a view's linear picture as numbers, one or three, or what is there instead: "nothing".
std::vector<std::string> pixelNumbers(uint32_t kind, const glm::vec4& linear);

}  // namespace irad
