// view_layout.h - the data from which engine/tools/render draws pictures (GLSL and C++).
//
// A fine frame is four passes: the nearest depth of all splats; the mean of normals, colours and depths of the splats
// near that depth; the surface that they make; its light, over which the shapes (proxy, arrows, ...) are drawn. A fast
// frame has only the last pass, with points that are lit one by one.
// View space: x right, y up, z towards the eye, lengths in m about the scene's own origin.
#ifndef PALPATE_VIEW_LAYOUT_H
#define PALPATE_VIEW_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
namespace palp::shared {
using uint = std::uint32_t;
using glm::mat4;
using glm::vec3;
#define PALPATE_VIEW_CONST inline constexpr uint
#else
#define PALPATE_VIEW_CONST const uint
#endif

// Bindings, the same in every pass.
PALPATE_VIEW_CONST kBindFrame   = 0; // ViewFrame
PALPATE_VIEW_CONST kBindSplats  = 1; // ViewSplat[]
PALPATE_VIEW_CONST kBindShapes  = 2; // ViewCorner[], three to a triangle
PALPATE_VIEW_CONST kBindDepth   = 3; // nearest depth of all splats [m]
PALPATE_VIEW_CONST kBindNormals = 4; // sum of weighted normals, and of weights
PALPATE_VIEW_CONST kBindColours = 5; // sum of weighted colours, and of weighted depths behind the nearest [px]
PALPATE_VIEW_CONST kBindSurface = 6; // unit normal in view space, and depth [m]; depth 0: nothing there
PALPATE_VIEW_CONST kBindAlbedo  = 7; // colour of the surface
PALPATE_VIEW_CONST kBindOverlay = 8; // pixels of the overlay, rows from the top, red in the lowest byte, premultiplied
PALPATE_VIEW_CONST kBindTiles =
    9; // squares of it, then of the panels, that are not empty: column, and row from the 16th bit on
PALPATE_VIEW_CONST kBindFaces  = 10; // numbers of splats, three to a triangle
PALPATE_VIEW_CONST kBindPanels = 11; // colours of the panels, premultiplied

PALPATE_VIEW_CONST kHollow = 4; // scale of hollowness: beyond 1/8 nothing gets darker or lighter, see cueOf() [1]

PALPATE_VIEW_CONST kTile = 32; // side of such a square [px]

// No vector crosses a multiple of 16 bytes and sizes are such multiples, so that std430 is the layout of C++.
struct ViewFrame {
    mat4  viewFromWorld;
    mat4  clipFromView;
    vec3  groundAbove; // colour behind everything, at the top of the picture
    float width;       // of the picture [px]
    vec3  groundBelow; // and at its foot
    float height;      // [px]
    float widthAtOne;  // half the width of the view at depth 1 m, or at any depth if orthographic [m]
    float heightAtOne; // [m]
    float cueRadius;   // of the surroundings that distinguish hollows from humps [m]
    float cueGain;     // of their rise [1]
    float shine;       // share of the surface's light that is a reflection [1]
    float even;         // share of the light that comes from everywhere alike, and shows no relief [1]
    float hiddenShare;  // share of a shape that shows through the surface [1]
    uint  orthographic; // 1: the eye is infinitely far away
};

struct ViewSplat {
    vec3  position; // [m]
    float radius;   // [m]; negative: only the side of the normal is seen, and the radius is its size
    vec3  normal;   // unit
    uint  colour;   // red in the lowest byte; the highest one, in fine pictures: how much of the radius covers what is
                    // behind [1/255]; in fast ones, whose radius is that part: 1/2 + kHollow times hollowness [1/255]
};

struct ViewCorner {
    vec3  position; // [m]
    uint  colour;   // red in the lowest byte
    vec3  normal;   // unit
    float unused;
};

#ifdef __cplusplus
static_assert(sizeof(ViewSplat) == 32 && sizeof(ViewCorner) == 32 && sizeof(ViewFrame) == 2 * 64 + 4 * 16,
              "the layout is that of the shaders");
} // namespace palp::shared
#endif
#endif
