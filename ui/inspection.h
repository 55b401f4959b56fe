// What the inspector shows in the window: a picked facet's record, and what was asked for beyond it. Its panel and
// overlay read it and write requests; the loop serves them between frames, and reads the device once per request or
// relight.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "gi/inspected.h"
#include "gi/pipeline.h"
#include "ui/link_filter.h"

namespace irad {

class Inspector;
struct Session;
struct ShownPoint;

class Inspection {
 public:
  Inspection();
  ~Inspection();

  // ---- What is shown ----
  std::optional<InspectedVoxel> voxel;  ///< none: nothing is picked; it may hold no facet, in slices
  size_t chosen = 0;                    ///< of the voxel's facets
  const InspectedFacet* facet() const {
    return voxel && chosen < voxel->facets.size() ? &voxel->facets[chosen] : nullptr;
  }
  std::optional<InspectedFacet> other;  ///< to compare with
  std::optional<RowComparison> comparison;
  std::optional<InspectedRay> ray;
  std::optional<SolveHistory> replay;  ///< of the chosen facet, from the dark
  struct Sample {
    uint64_t sweep;  ///< since the pick
    glm::vec3 irradiance;
  };
  std::deque<Sample> live;  ///< H of the chosen facet after each call of the solver since the pick
  uint64_t serial = 0;      ///< raised whenever any of these changes

  // ---- How ----
  enum class Show { Row, Column, Comparison } shown = Show::Row;
  std::optional<uint32_t> highlighted;  ///< far end of the link that the mouse is on in the table
  LinkFilter linkFilter;                ///< of the table, and so of the lines in the picture
  uint64_t linkFilterEdits = 0;         ///< raised when that changes
  std::vector<uint32_t> trail;          ///< facets that were left by following links

  // ---- Requests ----
  struct Pick {
    glm::uvec2 pixel;
    bool compare;
    bool other = false;  ///< a voxel of the side that is not edited, which is edited from then on
  };
  std::optional<Pick> pick;
  std::optional<uint32_t> follow;    ///< a facet
  std::optional<uint32_t> traceRay;  ///< number of a ray of the chosen facet
  std::optional<size_t> choose;      ///< the other facet of the voxel
  bool goBack = false, wantReplay = false, clear = false;
  bool wanted() const { return pick || follow || choose || traceRay || goBack || wantReplay || clear; }

  /// Picks a voxel; UsageError where it is outside of the grid or empty.
  void open(Session& session, const glm::uvec3& voxel);
  /// Does what is wanted, and takes over what the pipeline has changed. True where something changed; errors are shown.
  bool serve(Session& session);
  /// The pipeline is about to be another one: nothing of the old one is kept but what is shown.
  void leavePipeline();
  /// The voxel's edge length, m.
  double edge() const;

 private:
  void serveRequests(Session& session);
  bool update(Session& session);
  Inspector& inspector(Session& session);
  std::optional<ShownPoint> surfaceUnder(Session& session, const glm::uvec2& pixel);
  std::optional<uint32_t> triangleUnder(Session& session, const glm::uvec2& pixel);
  std::optional<SliceCell> under(Session& session, const glm::uvec2& pixel);
  void pickFacet(uint32_t facet);
  void compareWith(uint32_t facet);
  void reset();
  void forgetRequests();

  std::unique_ptr<Inspector> inspector_;
  const Pipeline* of_ = nullptr;  ///< the inspector's
  std::filesystem::path scene_;   ///< the inspector's
  Revision revision_;             ///< that it has read
  uint64_t sweeps_ = 0;
};

}  // namespace irad
