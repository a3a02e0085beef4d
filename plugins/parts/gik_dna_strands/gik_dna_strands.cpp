// DNA bricks as straight strands: 16 nucleotides per cell in a column that begins at the cell's top and hangs
// eight nucleotides into the cell below, where they pair with that cell's own eight. Two cells of a brick are
// one strand, linked by a bridge at the top. Measures: DMDesign's, lattice units.
#include <diatom/part_runs.hpp>
#include <diatom/part_shapes.hpp>

using namespace diatom::sdk;

namespace {

constexpr double kHeight = 1.08, kRise = kHeight / 8; // of a nucleotide
constexpr double kColumn = 0.2;

/// Frame: origin in the first cell's centre, run along +x. The two columns stand on different sides of the
/// run, so that the four columns that pass through a cell (two layers, two directions) have a quarter each.
PartMesh strand(const MeshRequest &request)
{
   if (request.length > 2)
      throw Failure(DIATOM_LIMIT, "a strand links one or two cells, not " + std::to_string(request.length));
   const double w = kColumn;
   const auto box = [](Xy low, Xy high, std::uint32_t solid) {
      return Prism{{low, {high[0], low[1]}, high, {low[0], high[1]}}, solid};
   };
   std::vector<Prism> prisms{box({0, -w}, {w, 0}, 3)};
   if (request.length == 2) {
      prisms.push_back(box({w, -w}, {1 - w, 0}, 2));
      prisms.push_back(box({w, 0}, {1 - w, w}, 2));
      prisms.push_back(box({1 - w, 0}, {1, w}, 3));
   }
   const double top = kHeight / 2;
   PartMesh mesh;
   Prisms(mesh, request.pitch).add({top - 16 * kRise, top - kRise, top}, prisms);
   return mesh;
}

void decompose(const Call &call, const diatom_cells &cells, PartList &parts)
{
   needHeight(cells, kHeight, "DNA bricks");
   onePartPerRun(call, cells, parts, 2);
}

PartSet gikDnaStrands(const Values &)
{
   PartSet set;
   set.kinds = {{"strand", "DNA strand", 1}};
   set.lattices = {"org.diatom_cad.lattice.gik"};
   set.mesh = strand;
   set.decompose = decompose;
   return set;
}

} // namespace

DIATOM_PARTS(gikDnaStrands)
