// What cells are made of: looks, mass, stiffness, and what they do electrically. SI throughout.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace diatom {

/// Fifteen constants of a cell's bonds, in the cell's own axes (amoeba.md 1.3): axial per bond axis; shear
/// [bond axis][displacement axis], diagonal unused; bending and torsion per rotation axis. Stiffnesses are in
/// N/m and N m/rad, dampings in N s/m and N m s/rad.
struct BondConstants
{
   std::array<double, 3> axial{};
   std::array<std::array<double, 3>, 3> shear{};
   std::array<double, 3> bending{};
   std::array<double, 3> torsion{};
   friend bool operator==(const BondConstants &, const BondConstants &) = default;
};

/// What a driven cell does per volt between its terminals.
struct Actuation
{
   enum class Mode { axial, shear, bending, torsion };
   Mode mode = Mode::axial;
   int axis = 0;             // cell axis: direction of axial and shear, rotation axis of bending and torsion
   double strainPerVolt = 0; // of the whole cell: half of it goes to each of its two bonds
   bool axisFromWires = false; // the earlier programs: the axis is that of the two conductors beside the cell
   friend bool operator==(const Actuation &, const Actuation &) = default;
};

/// How a cell is represented in mechanics: by beam bonds to its neighbours; by bonds whose constants are
/// chosen for blocks that fill space (shear kappa = 2 G l, bond-model.md); or by solid elements with its
/// neighbours.
enum class CellModel : std::uint8_t { bond, block, solid };

enum class ElectricalRole : std::uint8_t { insulator, conductor, source, actuator };

struct Material
{
   std::string id;   // stable, in files and on the command line: [A-Za-z0-9_.-]+
   std::string name; // for people
   std::array<std::uint8_t, 3> color{0xaa, 0xaa, 0xaa};
   double density = 1000;      // kg/m3
   double youngsModulus = 1e6; // Pa
   double poissonRatio = 0.3;
   double dampingRatio = 0;               // of each bond, 1 = critical
   std::optional<BondConstants> bonds;    // instead of E and nu
   std::optional<BondConstants> dampings; // instead of the damping ratio
   /// Principal moments of inertia of a cell in its own axes, kg m2; instead of those of a full box.
   std::optional<std::array<double, 3>> inertia;
   CellModel cellModel = CellModel::bond;
   bool poissonCoupling = false; // of bonded cells: asks for the effect "poisson"
   ElectricalRole role = ElectricalRole::insulator;
   /// Faces that conduct, bit 2a for -axis a, bit 2a+1 for +axis a of the cell; all six for plain conductors.
   /// For an actuator or source: its terminals.
   std::uint8_t ports = 0x3f;
   Actuation actuation; // when role is actuator
   /// What solvers beyond mechanics ask for by name, as a heat conductivity. SI.
   std::map<std::string, double> properties;
   friend bool operator==(const Material &, const Material &) = default;
};

} // namespace diatom
