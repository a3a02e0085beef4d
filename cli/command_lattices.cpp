// diatom lattices: what the installed lattices are, in lattice units.
#include "cli/commands.h"

#include "lattice/lattice.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace diatom::cli {

namespace {

/// Cell, contacts and joined neighbours of a site.
nlohmann::ordered_json siteRow(const Lattice &lattice, int site)
{
   const Shape &shape = lattice.shape(site);
   std::array<int, 3> neighbours{};
   int joined = 0;
   for (const Link &link : lattice.links(site)) {
      ++neighbours[static_cast<std::size_t>(link.contact)];
      joined += link.joined ? 1 : 0;
   }
   nlohmann::ordered_json row;
   row["cell"] = {{"vertices", shape.vertices.size()},
                  {"edges", shape.edges.size()},
                  {"faces", shape.faces.size()},
                  {"volume", shape.volume}};
   row["neighbours"] = {{"face", neighbours[0]}, {"edge", neighbours[1]}, {"vertex", neighbours[2]}};
   row["joined"] = joined;
   return row;
}

nlohmann::ordered_json describe(const Lattice &lattice, const std::string &name)
{
   double volume = 0;
   for (int site = 0; site < lattice.sites(); ++site)
      volume += lattice.shape(site).volume;
   const auto first = siteRow(lattice, 0);
   nlohmann::ordered_json row;
   row["id"] = lattice.spec().id;
   row["name"] = name;
   row["period"] = lattice.period();
   row["cell"] = first["cell"];
   row["packing"] = volume / (lattice.sites() * lattice.volumePerSite());
   row["neighbours"] = first["neighbours"];
   row["joined"] = first["joined"];
   row["rotations"] = lattice.rotations().size();
   // Cells of a second kind, in a lattice of several.
   auto others = nlohmann::ordered_json::array();
   for (int site = 1; site < lattice.sites(); ++site) {
      auto other = siteRow(lattice, site);
      const bool known = other["cell"]["vertices"] == first["cell"]["vertices"] ||
                         std::any_of(others.begin(), others.end(), [&](const auto &o) {
                            return o["cell"]["vertices"] == other["cell"]["vertices"];
                         });
      if (!known)
         others.push_back(std::move(other));
   }
   if (!others.empty())
      row["others"] = std::move(others);
   return row;
}

/// The same in few columns, for people.
nlohmann::ordered_json brief(const nlohmann::ordered_json &row)
{
   const auto counts = [](const nlohmann::ordered_json &of, std::initializer_list<const char *> keys) {
      std::string text;
      for (const char *key : keys)
         text += (text.empty() ? "" : "/") + of[key].dump();
      return text;
   };
   const auto rounded = [](const nlohmann::ordered_json &value) {
      return std::round(value.get<double>() * 1e6) / 1e6;
   };
   std::string cell = counts(row["cell"], {"vertices", "edges", "faces"});
   std::string touching = counts(row["neighbours"], {"face", "edge", "vertex"});
   std::string joined = row["joined"].dump();
   for (const auto &other : row.value("others", nlohmann::ordered_json::array())) {
      cell += ", " + counts(other["cell"], {"vertices", "edges", "faces"});
      touching += ", " + counts(other["neighbours"], {"face", "edge", "vertex"});
      joined += ", " + other["joined"].dump();
   }
   return {{"id", row["id"]},
           {"name", row["name"]},
           {"corners/edges/faces", cell},
           {"volume", rounded(row["cell"]["volume"])},
           {"packing", rounded(row["packing"])},
           {"touching by face/edge/corner", touching},
           {"joined", joined},
           {"rotations", row["rotations"]}};
}

/// All of them, or those named by their id or its last word.
void run(const std::vector<std::string> &wanted, Context &context)
{
   const auto catalogue = context.catalogue();
   std::vector<std::string> ids;
   for (const std::string &given : wanted)
      ids.push_back(fullId(*catalogue, DIATOM_LATTICE_1, given));
   if (wanted.empty())
      for (const Offer &offer : catalogue->offers(DIATOM_LATTICE_1))
         ids.push_back(offer.provided->id);
   auto rows = nlohmann::ordered_json::array();
   for (const std::string &id : ids) {
      LatticeSpec spec;
      spec.id = id;
      spec.pitch = 1; // so that lengths are lattice units
      const auto lattice = Lattice::make(*catalogue, spec, context.job());
      if (lattice)
         rows.push_back(describe(**lattice, catalogue->offer(DIATOM_LATTICE_1, id)->provided->name));
      else
         context.fail(lattice.error());
   }
   if (!context.json)
      for (auto &row : rows)
         row = brief(row);
   context.printTable(rows);
}

} // namespace

void addLattices(CLI::App &app, Context &context)
{
   CLI::App *command =
       app.add_subcommand("lattices", "List the lattices: cell, packing, neighbours, rotations");
   const auto wanted = std::make_shared<std::vector<std::string>>();
   command->add_option("ID", *wanted, "Only these, each by its id or its last word");
   command->callback([&context, wanted] { run(*wanted, context); });
}

} // namespace diatom::cli
