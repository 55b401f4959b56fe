// EXT_meshopt_compression and the version-0 streams of KHR_meshopt_compression, by libmeshoptimizer.
#ifdef IRAD_OIIO
#include <meshoptimizer.h>

#include "renderer/scene/gltf_document.h"

namespace irad::gltf {

Bytes decodeMeshopt(Document& doc, ByteSpan source, uint32_t count, uint32_t stride, const std::string& mode,
                    const std::string& filter, const std::string& where) {
  Bytes out(uint64_t{count} * stride);
  int result = -1;
  if (mode == "ATTRIBUTES") {
    if (stride % 4 != 0 || stride > 256)
      doc.fail(where + ".byteStride", fmt::format("{} is not a multiple of 4 up to 256", stride));
    result = meshopt_decodeVertexBuffer(out.data(), count, stride, source.data(), source.size());
  } else if (mode == "TRIANGLES" || mode == "INDICES") {
    if (stride != 2 && stride != 4) doc.fail(where + ".byteStride", fmt::format("{} is neither 2 nor 4", stride));
    if (mode == "TRIANGLES") {
      if (count % 3 != 0) doc.fail(where + ".count", fmt::format("{} is not a multiple of 3", count));
      result = meshopt_decodeIndexBuffer(out.data(), count, stride, source.data(), source.size());
    } else {
      result = meshopt_decodeIndexSequence(out.data(), count, stride, source.data(), source.size());
    }
  } else {
    doc.fail(where + ".mode", fmt::format("\"{}\" is not known", mode.substr(0, 40)));
  }
  if (result != 0) doc.fail(where, fmt::format("the compressed data is damaged (meshoptimizer says {})", result));
  if (filter == "NONE") return out;
  if (mode != "ATTRIBUTES") doc.fail(where + ".filter", fmt::format("\"{}\" on indices", filter.substr(0, 40)));
  if (filter == "OCTAHEDRAL") {
    if (stride != 4 && stride != 8)
      doc.fail(where + ".byteStride", fmt::format("{} with an octahedral filter", stride));
    meshopt_decodeFilterOct(out.data(), count, stride);
  } else if (filter == "QUATERNION") {
    if (stride != 8) doc.fail(where + ".byteStride", fmt::format("{} with a quaternion filter", stride));
    meshopt_decodeFilterQuat(out.data(), count, stride);
  } else if (filter == "EXPONENTIAL") {
    meshopt_decodeFilterExp(out.data(), count, stride);
  } else {
    doc.fail(where + ".filter", fmt::format("\"{}\" is not known", filter.substr(0, 40)));
  }
  return out;
}

}  // namespace irad::gltf

#else
#include "renderer/scene/gltf_document.h"

namespace irad::gltf {

Bytes decodeMeshopt(Document& doc, ByteSpan, uint32_t, uint32_t, const std::string&, const std::string&,
                    const std::string& where) {
  doc.fail(where, "this build has no meshoptimizer (use an .irscene cache written by the full build)");
}

}  // namespace irad::gltf
#endif
