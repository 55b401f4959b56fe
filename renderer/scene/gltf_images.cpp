// Images: found, read, decoded in parallel. What cannot be had becomes pink, with a warning that names it.
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>

#include "renderer/base/parallel.h"
#include "renderer/scene/gltf_document.h"

namespace irad::gltf {
namespace {

struct Job {
  std::string name, problem;
  Bytes data;
  ByteSpan bytes;
  ImageHeader header;
  SceneImage image;
};

/// Memory for decoding, shared by the threads: a thread that needs more than is left waits for the others.
class Scratch {
 public:
  void take(uint64_t bytes) {
    std::unique_lock lock(mutex_);
    freed_.wait(lock, [&] { return left_ >= bytes; });
    left_ -= bytes;
  }
  void give(uint64_t bytes) {
    {
      const std::lock_guard lock(mutex_);
      left_ += bytes;
    }
    freed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable freed_;
  uint64_t left_ = kMaxImageScratch;
};

/// The encoded bytes of an image: bufferView, data URI or a file beside the scene.
void locate(Document& doc, int source, Job& job) {
  if (source < 0) {
    job.problem = "its texture names no image that can be read";
    return;
  }
  const Json& json = doc.root->at("images")[static_cast<size_t>(source)];
  job.name = json.value("name", std::string());
  if (json.contains("bufferView")) {
    const View& view = doc.views[json.at("bufferView").get<size_t>()];
    if (!view.present) job.problem = "its bufferView has no data";
    job.bytes = view.bytes;
  } else if (json.contains("uri")) {
    const std::string uri = json.at("uri").get<std::string>();
    if (isDataUri(uri)) {
      std::string mime;
      if (!decodeDataUri(uri, job.data, mime)) job.problem = "its data URI is malformed";
    } else {
      if (job.name.empty()) job.name = uri;
      const std::filesystem::path path = resolveUri(doc, uri, job.problem);
      if (job.problem.empty()) job.data = readFile(path, kMemoryBudget / 4, job.problem);
      if (!job.problem.empty()) job.problem = fmt::format("\"{}\": {}", uri.substr(0, 200), job.problem);
    }
    doc.take(job.data.size(), fmt::format("images[{}]", source));
    job.bytes = job.data;
  } else {
    job.problem = "has neither uri nor bufferView";
  }
  if (job.name.empty()) job.name = fmt::format("image {}", source);
}

/// Whether the image may be decoded, by what its first bytes state; `total` sums the results of those that may.
void measure(Job& job, uint64_t& total) {
  if (!job.problem.empty()) return;
  const std::optional<ImageHeader> header = readImageHeader(job.bytes);
  job.problem = header ? imageTooLarge(*header) : "is neither PNG, JPEG nor WebP";
  if (!job.problem.empty()) return;
  if (total + header->resultBytes() > kMaxImageBytes) {
    job.problem = fmt::format("needs {} MiB, more than is left for images", header->resultBytes() >> 20);
  } else {
    job.header = *header;
    total += header->resultBytes();
  }
}

void decode(Job& job, Scratch& scratch) {
  if (!job.problem.empty()) return;
  scratch.take(job.header.scratchBytes());
  try {
    const DecodeResult result = decodeImage(job.bytes, job.header, job.image);
    if (!result.ok) job.problem = result.why;
  } catch (const std::exception& error) {
    job.problem = error.what();
  }
  scratch.give(job.header.scratchBytes());
}

SceneImage pink() {
  SceneImage image;
  image.width = image.height = 8;
  for (int i = 0; i < 64; ++i) image.rgba.insert(image.rgba.end(), {255, 0, 255, 255});
  return image;
}

}  // namespace

void loadImages(Document& doc, const std::vector<ImageRequest>& requests, const LoadOptions& options, Scene& scene) {
  // One job per image of the file; requests in another colour space share it.
  std::vector<int> sources;
  std::vector<size_t> jobOf;
  for (const ImageRequest& request : requests) {
    const auto found = std::find(sources.begin(), sources.end(), request.source);
    jobOf.push_back(static_cast<size_t>(found - sources.begin()));
    if (found == sources.end()) sources.push_back(request.source);
  }
  std::vector<Job> jobs(sources.size());
  uint64_t total = 0;
  for (size_t j = 0; j < jobs.size(); ++j) locate(doc, sources[j], jobs[j]), measure(jobs[j], total);
  for (const size_t j : jobOf) doc.take(jobs[j].header.resultBytes(), "images");

  Scratch scratch;
  parallelFor(jobs.size(), [&](size_t j) { decode(jobs[j], scratch); });
  if (options.progress) options.progress(0.8f, "images");

  std::vector<size_t> uses(jobs.size(), 0);
  for (const size_t j : jobOf) ++uses[j];
  for (size_t i = 0; i < requests.size(); ++i) {
    Job& job = jobs[jobOf[i]];
    if (!job.problem.empty()) {
      doc.release(job.header.resultBytes());
      doc.warn(fmt::format("{}: {}{}; pink stands in for it", requests[i].user,
                           job.name.empty() ? "" : "image \"" + job.name + "\" ", job.problem));
    }
    SceneImage image = !job.problem.empty() ? pink() : --uses[jobOf[i]] == 0 ? std::move(job.image) : job.image;
    image.name = job.name;
    image.srgb = requests[i].srgb;
    scene.images.push_back(std::move(image));
  }
}

}  // namespace irad::gltf
