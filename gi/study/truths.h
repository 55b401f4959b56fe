// Truths that studies compute, pictures of two halves with independent noise, in a folder that any number of studies
// share: what each depends on says its name, so that the very same one is made once, and no other is taken for it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gi/settings.h"
#include "renderer/base/image_io.h"

namespace irad {

struct Camera;
struct Sky;
struct TraceOptions;

/// All that the pictures of a truth depend on. Recipes that are equal give the same bits.
struct TruthRecipe {
  std::string label;  ///< for people: scene, camera, view, of letters that files may have
  std::string made;   ///< JSON of names and values
  /// Of the truth's files: "box-main-indirect-1a2b3c4d5e", the label and the beginning of the hash of `made`.
  std::string name() const;
};

/// What truths of both kinds depend on.
struct TruthSubject {
  std::string program;    ///< version and commit
  std::string scene;      ///< sceneContent()
  std::string sceneName;  ///< for the label
  const Camera& camera;   ///< its name is for the label only
  glm::uvec2 size{0};
  std::string view;
};
/// The path tracer's, of the halves of its samples. The sky is what the tracer is given beside the scene.
TruthRecipe tracedTruth(const TruthSubject& subject, const Sky& sky, const TraceOptions& options);
/// The program's own pictures with these settings, of the seeds matrix.seed + kHalfSeeds.
TruthRecipe drawnTruth(const TruthSubject& subject, const Settings& settings, const std::string& device);
inline constexpr std::array<uint32_t, 2> kHalfSeeds{1'000'000, 2'000'000};  ///< no seed of a point

/// The folder of truths. Of each: NAME.a.exr and NAME.b.exr (or .pfm), its halves, and NAME.json, which has the recipe
/// and vouches for them by their SHA-256; while it is traced NAME.state. Files are replaced whole, so that several
/// programs may work in one folder.
class TruthStore {
 public:
  explicit TruthStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Half 0 or 1 of a truth, alpha 1; none where it is not there, or not as NAME.json vouches for it (then `spoilt`,
  /// where given, says so). InputError where NAME.json is of another recipe, or no such file.
  std::optional<LinearPicture> find(const TruthRecipe& recipe, int half, std::string* spoilt = nullptr) const;
  bool has(const TruthRecipe& recipe) const;  ///< both halves, as find() would give them
  /// `subject`: what the file says of itself, so that it serves as --reference, too.
  void keep(const TruthRecipe& recipe, int half, glm::uvec2 size, const std::vector<glm::vec4>& pixels,
            const PictureSubject& subject) const;
  std::filesystem::path stateFile(const TruthRecipe& recipe) const;

 private:
  /// A half's file, where it is the one that is vouched for.
  std::optional<std::filesystem::path> whole(const TruthRecipe& recipe, int half, std::string* spoilt) const;
  std::filesystem::path stem(const TruthRecipe& recipe, int half) const;
  std::filesystem::path folder_;
};

}  // namespace irad
