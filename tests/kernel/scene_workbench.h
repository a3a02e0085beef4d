// Small designs for the tests of kernel/scene: a lattice, a few materials, cells put where the test says.
#pragma once

#include "cells/hierarchy.h"
#include "scene/setup.h"
#include "support/support.h"

#include <memory>
#include <string>
#include <vector>

namespace diatom::test {

inline Material material(const std::string &id, ElectricalRole role = ElectricalRole::insulator)
{
   Material made;
   made.id = id;
   made.name = id;
   made.role = role;
   return made;
}

struct Workbench
{
   Model model;
   Setup setup;
   std::shared_ptr<const Lattice> lattice;
   std::shared_ptr<Job> ownedJob = std::make_shared<Job>();
   Job &job = *ownedJob;

   explicit Workbench(const std::string &id = "org.diatom_cad.lattice.cube")
   {
      model.lattice.id = id;
      const auto made = Lattice::make(*catalogue(), model.lattice, job);
      if (!made)
         qFatal("%s", made.error().message.c_str());
      lattice = *made;
      add(material("plain"));
      add(material("wire", ElectricalRole::conductor));
      add(material("signal", ElectricalRole::source));
      Material piezo = material("piezo", ElectricalRole::actuator);
      piezo.actuation = {Actuation::Mode::axial, 0, 0.3, true};
      add(piezo);
      Material own = piezo;
      own.id = "own-terminals";
      own.actuation.axisFromWires = false;
      add(own);
      Material bar = material("bar", ElectricalRole::conductor);
      bar.ports = 0x03; // -x and +x of the cell
      add(bar);
      Material battery = material("battery", ElectricalRole::source);
      battery.ports = 0x03;
      add(battery);
   }

   void add(const Material &one)
   {
      const auto index = model.setMaterial(one);
      if (!index)
         qFatal("%s", index.error().message.c_str());
   }
   /// Puts cells of one material.
   void put(const std::string &id, const std::vector<Index> &cells, std::uint8_t orientation = 0)
   {
      const MaterialIndex index = model.material(id);
      if (index == 0)
         qFatal("no material %s", id.c_str());
      for (const Index cell : cells)
         model.root.cells.set(cell, Cell{index, orientation, 0});
   }
   void block(const std::string &id, const Box &box)
   {
      model.root.cells.fill(box, Cell{model.material(id), 0, 0});
   }
   /// A source cell with its signal.
   void source(Index cell, double amplitude = 1, const std::string &id = "signal")
   {
      put(id, {cell});
      Source signal;
      signal.cell = cell;
      signal.amplitude = amplitude;
      setup.sources.push_back(signal);
   }
   Hierarchy hierarchy() const { return Hierarchy(lattice, model); }
   /// The rotation number that turns cell axis `from` to world axis `to`.
   std::uint8_t turn(const Vec3 &from, const Vec3 &to) const
   {
      const auto &rotations = lattice->shape(0).rotations;
      for (std::size_t r = 0; r < rotations.size(); ++r)
         if ((rotations[r] * from - to).norm() < 1e-9)
            return static_cast<std::uint8_t>(r);
      qFatal("no such rotation");
   }
};

} // namespace diatom::test
