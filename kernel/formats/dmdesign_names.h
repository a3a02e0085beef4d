// What DMDesign calls lattices, heights of bricks and units, and what they are here.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace diatom::dmdesign {

struct LatticeName
{
   const char *cell, *connection, *id; // the program's two keys, our lattice
   std::array<double, 3> pitch;        // its "aspect ratio", as the program had it
};

inline const double kRoot2 = std::sqrt(2.0), kRow = std::sqrt(3.0) / 2, kLayer = 2 / std::sqrt(6.0);

// The fourth and the eighth were in no menu of the program, but its files may name them.
inline const std::array<LatticeName, 12> kLattices = {{
    {"cube", "face", "cube", {1, 1, 1}},
    {"cube", "gik", "gik", {1, 1, 1}},
    {"octa", "face", "octahedron_face", {1, kRow, kLayer}},
    {"octa", "edge", "octahedron_edge_flat", {1, kRow, kLayer}},
    {"octa", "edgeRot", "octahedron_edge", {1, 1, kRoot2 / 2}},
    {"octa", "vertex", "octahedron_vertex", {kRoot2, kRoot2, kRoot2}},
    {"tetra", "stacked", "tetrahedron_stacked", {1, kRow, kLayer}},
    {"tetra", "vertex", "tetrahedron_vertex", {1, kRow, kLayer}},
    {"truncatedCube", "face", "cuboctahedron", {kRoot2, kRoot2, kRoot2}},
    {"kelvin", "face", "kelvin", {2 * kRoot2, 2 * kRoot2, 2 * kRoot2}},
    {"hex", "face", "honeycomb", {2 * kRow, 1.5, 1}},
    {"hex", "faceRot", "honeycomb_rotated", {3, 1, kRow}},
}};

/// Height of a GIK cell over its width, by application.
inline constexpr std::array<std::pair<const char *, double>, 3> kHeights = {
    {{"willGik", 1.28}, {"lego", 1.17}, {"dnaBricks", 1.08}}};

inline constexpr std::array<std::pair<const char *, double>, 4> kUnits = {
    {{"inches", 0.0254}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}}};

} // namespace diatom::dmdesign
