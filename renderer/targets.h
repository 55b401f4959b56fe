// What pictures are composed from, per pixel.
#pragma once

#include "renderer/frame/frame.h"

namespace irad {

/// Which surfaces a picture shows (docs/method.md 7). first: all, the nearest; behind: those behind the layer before,
/// of blended materials, or the opaque ones; opaque: these alone.
enum class Layer { first, behind, opaque };

/// Results of the forward pass, of traced reflections and of views. fp32 where light is held, so that emission from
/// 1e-6 to 1e6 survives. The second group exists only where a pass writes it: an absent term is 0.
struct Targets {
  Targets() = default;
  Targets(Context& context, glm::uvec2 size);
  glm::uvec2 size{0};
  Image depth;      ///< D32, or R32F where kernels rasterize; 1 = nothing
  Image normal;     ///< RGBA16F: shading normal xyz, roughness
  Image geometric;  ///< RGBA16F: geometric normal xyz (towards the viewer), metallic (packCover() of blended surfaces)
  Image albedo;     ///< RGBA16F: diffuse albedo (base colour x (1 - metallic)), occlusion
  Image direct;  ///< RGBA32F: direct irradiance D, W/m^2 (sun, spot, point); w: what the surface lets through of each
                 ///< channel, packPasses() of shaders/shared/glass.h, where panes tint
  Image linear;  ///< RGBA32F: the view's result, before exposure, tone curve or colour map; alpha 0: nothing drawn.
                 ///< Passes before the view keep what they need for themselves there
  Buffer viewRange;  ///< one ViewRange (shaders/shared/view.h), of views that have one
  Buffer viewBins;   ///< histogram of their values
  Image display;     ///< RGBA8: what is shown and written as PNG (sRGB-encoded)

  Image f0;         ///< RGBA16F: specular reflectance at normal incidence; w: 1 = has a specular lobe
  Image highlight;  ///< RGBA32F: outgoing radiance: direct lights' specular lobe + emission (w: emission luminance)
  Image indirect;   ///< RGBA32F: indirect irradiance H, W/m^2; w: with facets of the true surface the triangle seen
                    ///< (seenAs()). Before a pass looks it up, the position
  Image emitted;   ///< RGBA32F: the part of H that comes straight from emissive surfaces, where a view asks; w: how far
                   ///< a pixel is to go by what it finds itself ("RE Emitters"), 0 to 1: not at all where the facets
                   ///< around agree, wholly where there is none
  Image seen;      ///< RGBA16F: how much of the emitters' light arrives, by channel, where pixels look for it; w = 0:
                   ///< unknown. No picture is composed from it
  Image specular;  ///< RGBA32F: reflected radiance of indirect specular light (BRDF included)
  // Where kernels rasterize:
  Buffer visible;  ///< uint64 per pixel, row by row: ~bits of the depth << 32 | triangle of what is seen, all bits set
                   ///< where nothing is
  Buffer rasterQueue;   ///< renderer/raster.h
  Buffer pixelLists;    ///< a PixelList per material and one more
  Buffer listedPixels;  ///< the lists' entries: x | y << 16, triangle

  // Where blended surfaces are drawn by layers:
  Image layers;          ///< RGBA32F: the sum so far, and the share of what is behind that shows
  Image shows;           ///< RGBA32F: that share by channel, where panes tint
  Image peeled;          ///< R32F: depth of the last layer
  Buffer peeledVisible;  ///< `visible` of the last layer, where kernels rasterize

  Buffer facet;  ///< uint per pixel, row by row: the facet that it lies on, NO_FACET (shared/facets.h) where there is
                 ///< none; where reflections are written back and lookups go by facets

  // Lists of pixels (shaders/shared/picked.h), where there are the passes that make them:
  Buffer sought;        ///< whose facet is searched for
  Buffer soughtAround;  ///< and in other voxels, too, where the search has parts
  Buffer doubted;       ///< whose direct light is asked of rays
  Buffer glossy;        ///< that trace specular rays

  /// Whose surfaces are in it, with what light: for pictures that share them (PictureOptions::shareSurfaces).
  struct Surfaces {
    uint64_t key = 0;   ///< of what they are drawn from; 0: none that can be shared
    uint32_t from = 0;  ///< FROM_* (shaders/shared/debug_views.h)
  } surfaces;

  /// Who writes `depth`: the graphics pipeline, or kernels, by way of `visible`.
  void fitRaster(Context& context, bool kernels, uint32_t triangles);
  /// Makes what layers are put together in, or frees it. After fitRaster().
  void fitLayers(Context& context, bool wanted, bool tinted = false);
  /// Makes one of the images of the second group, or frees it once the device has finished with it.
  void fit(Context& context, Image Targets::*image, bool wanted);
  /// TARGET_* of shaders/shared/passes.h: those of them that exist.
  uint32_t present() const;
  /// The image or, where it is absent, another of its format in its place, which the shader, told by present(), does
  /// not touch.
  const Image& bound(Image Targets::*image) const;
};

}  // namespace irad
