// The shader programs. Light is constant over a face, so that it is worked out per corner; lines between
// cells come from edge coordinates (render/face_types.h) in screen pixels. For the .cpp files of render/
// only.
#pragma once

namespace diatom::render {

/// shared by vertex shaders: two lights and a brighter sky; see also shade() in renderer.cpp, its twin on the
/// CPU.
#define DIATOM_SHADE                                                                                         \
   "float shade(vec3 n) {\n"                                                                                 \
   "   return 0.50 + 0.13 * n.z + 0.40 * max(dot(n, vec3(0.331, -0.662, 0.672)), 0.0)\n"                     \
   "        + 0.13 * max(dot(n, vec3(-0.696, 0.398, 0.597)), 0.0);\n"                                        \
   "}\n"

/// Cells: one instance per exposed face. TURNED: with a rotation per cell.
inline constexpr const char *kCellVertex = DIATOM_SHADE R"(
layout(location = 0) in vec3 corner;
layout(location = 1) in vec4 edge;
layout(location = 2) in uint slot;
uniform samplerBuffer positions;
uniform samplerBuffer turns;
uniform samplerBuffer colors;
uniform mat4 transform;
uniform vec3 normal;
flat out vec3 color;
out vec4 along;
vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.yzw, cross(q.yzw, v) + q.x * v); }
void main()
{
   int s = int(slot);
#ifdef TURNED
   vec4 q = texelFetch(turns, s);
   vec3 p = turn(q, corner);
   vec3 n = turn(q, normal);
#else
   vec3 p = corner;
   vec3 n = normal;
#endif
   gl_Position = transform * vec4(texelFetch(positions, s).xyz + p, 1.0);
   color = texelFetch(colors, s).rgb * shade(n);
   along = edge;
}
)";

/// Boxes: plain triangles.
inline constexpr const char *kBoxVertex = DIATOM_SHADE R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 edge;
layout(location = 3) in vec4 tint;
uniform mat4 transform;
flat out vec3 color;
out vec4 along;
void main()
{
   gl_Position = transform * vec4(position, 1.0);
   color = tint.rgb * shade(normal);
   along = vec4(edge, 0.0, 0.0);
}
)";

/// Parts and struts: triangles that are lit already.
inline constexpr const char *kSurfaceVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 edge;
layout(location = 2) in vec3 tint;
uniform mat4 transform;
flat out vec3 color;
out vec4 along;
void main()
{
   gl_Position = transform * vec4(position, 1.0);
   color = tint;
   along = vec4(edge, 0.0);
}
)";

/// All of the above. Lines fade where cells become too small on screen to need them.
inline constexpr const char *kFaceFragment = R"(
flat in vec3 color;
in vec4 along;
uniform float lineWidth;
out vec4 result;
void main()
{
   vec4 slope = max(fwidth(along), vec4(1e-9));
   vec4 pixels = (1.0 - abs(along)) / slope;
   float near = min(min(pixels.x, pixels.y), min(pixels.z, pixels.w));
   float steepest = max(max(slope.x, slope.y), max(slope.z, slope.w));
   float strength = clamp(0.30 / steepest - 0.55, 0.0, 1.0);
   float line = (1.0 - clamp(near - lineWidth + 0.5, 0.0, 1.0)) * strength;
   result = vec4(mix(color, color * 0.42, line), 1.0);
}
)";

inline constexpr const char *kLineVertex = R"(
layout(location = 0) in vec3 start;
layout(location = 1) in vec3 end;
layout(location = 2) in vec3 place; // 0 at start or 1 at end, side -1 or 1, width in pixels
layout(location = 3) in vec4 tint;
uniform mat4 transform;
uniform vec2 size; // pixels
out vec4 color;
out vec2 across; // pixels from the middle, half the width
void main()
{
   vec4 a = transform * vec4(start, 1.0), b = transform * vec4(end, 1.0);
   float least = 1e-4 * (abs(a.w) + abs(b.w));
   // An end behind the eye is moved along the line to just before it.
   if (a.w < least && b.w > least) a = mix(a, b, (least - a.w) / (b.w - a.w));
   if (b.w < least && a.w > least) b = mix(b, a, (least - b.w) / (a.w - b.w));
   vec2 pa = a.xy / a.w * size * 0.5, pb = b.xy / b.w * size * 0.5;
   vec2 d = pb - pa;
   float len = length(d);
   d = len > 1e-6 ? d / len : vec2(1.0, 0.0);
   float half_ = 0.5 * place.z + 1.0;
   vec2 off = (vec2(-d.y, d.x) * place.y + d * (place.x * 2.0 - 1.0) * 0.5) * half_;
   vec4 p = place.x < 0.5 ? a : b;
   gl_Position = vec4(p.xy + off / (size * 0.5) * p.w, p.z - 2e-5 * p.w, p.w);
   across = vec2(place.y * half_, 0.5 * place.z);
   color = tint;
}
)";
inline constexpr const char *kLineFragment = R"(
in vec4 color;
in vec2 across;
uniform float opacity;
out vec4 result;
void main()
{
   float cover = clamp(across.y + 0.5 - abs(across.x), 0.0, 1.0);
   result = vec4(color.rgb, color.a * opacity * cover);
}
)";

inline constexpr const char *kFillVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 tint;
uniform mat4 transform;
out vec4 color;
void main()
{
   gl_Position = transform * vec4(position, 1.0);
   color = tint;
}
)";
inline constexpr const char *kFillFragment = R"(
in vec4 color;
uniform float opacity;
out vec4 result;
void main() { result = vec4(color.rgb, color.a * opacity); }
)";

/// One triangle over the whole picture, from colour to colour.
inline constexpr const char *kBackgroundVertex = R"(
out float height;
void main()
{
   vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
   height = p.y * 0.5 + 0.5;
   gl_Position = vec4(p, 1.0, 1.0);
}
)";
inline constexpr const char *kBackgroundFragment = R"(
in float height;
uniform vec3 low;
uniform vec3 high;
out vec4 result;
void main() { result = vec4(mix(low, high, clamp(height, 0.0, 1.0)), 1.0); }
)";

} // namespace diatom::render
