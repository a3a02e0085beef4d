// diatom lattices: what the installed lattices are, in lattice units.
#include "cli/commands.h"

#include "lattice/lattice.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

namespace diatom::cli {

namespace {

nlohmann::ordered_json describe(const Lattice &lattice, const std::string &name)
{
   const Shape &shape = lattice.shape(0);
   std::array<int, 3> neighbours{};
   int joined = 0;
   for (const Link &link : lattice.links(0)) {
      ++neighbours[static_cast<std::size_t>(link.contact)];
      joined += link.joined ? 1 : 0;
   }
   double volume = 0;
   for (int site = 0; site < lattice.sites(); ++site)
      volume += lattice.shape(site).volume;

   nlohmann::ordered_json row;
   row["id"] = lattice.spec().id;
   row["name"] = name;
   row["period"] = lattice.period();
   row["cell"] = {{"vertices", shape.vertices.size()},
                  {"edges", shape.edges.size()},
                  {"faces", shape.faces.size()},
                  {"volume", shape.volume}};
   row["packing"] = volume / (lattice.sites() * lattice.volumePerSite());
   row["neighbours"] = {{"face", neighbours[0]}, {"edge", neighbours[1]}, {"vertex", neighbours[2]}};
   row["joined"] = joined;
   row["rotations"] = lattice.rotations().size();
   return row;
}

void run(Context &context)
{
   const auto catalogue = context.catalogue();
   auto rows = nlohmann::ordered_json::array();
   for (const Offer &offer : catalogue->offers(DIATOM_LATTICE_1)) {
      LatticeSpec spec;
      spec.id = offer.provided->id;
      spec.pitch = 1; // so that lengths are lattice units
      const auto lattice = Lattice::make(*catalogue, spec, context.job());
      if (lattice)
         rows.push_back(describe(**lattice, offer.provided->name));
      else
         context.fail(lattice.error());
   }
   context.printTable(rows);
}

} // namespace

void addLattices(CLI::App &app, Context &context)
{
   CLI::App *command =
       app.add_subcommand("lattices", "List the lattices: cell, packing, neighbours, rotations");
   command->callback([&context] { run(context); });
}

} // namespace diatom::cli
