#include "bonds_solver.h"

#include "explicit/explicit_run.h"

namespace bonds {

using sdk::Failure;

const diatom_capabilities &BondsSolver::capabilities()
{
   static const char *const kPhysics[] = {"mechanics"}, *const kAnalyses[] = {"dynamics"},
                            *const kLattices[] = {"*"};
   static const char *const kEffects[] = {"rotation", "damping", "gravity", "actuation", "ground",
                                          "friction", "drag",    "loads",   "solid",     "poisson"};
   static const diatom_capabilities kCaps{
       sizeof(diatom_capabilities), 1, 1, kPhysics, kAnalyses, 10, kEffects, 1, kLattices, 1};
   return kCaps;
}

namespace {

void refuseUnknown(std::string_view analysis)
{
   if (analysis != "dynamics")
      throw Failure(DIATOM_UNSUPPORTED,
                    "the analysis \"" + std::string(analysis) + "\" is not one of this solver's");
}

} // namespace

void BondsSolver::estimate(sdk::Call, sdk::Values values, const sdk::SceneView &scene,
                           diatom_estimate &estimate)
{
   refuseUnknown(scene.analysis());
   ExplicitRun::estimate(Options::from(values), scene, estimate);
}

BondsSolver::BondsSolver(sdk::Call, sdk::Values values, const sdk::SceneView &scene)
{
   refuseUnknown(scene.analysis());
   m_analysis = std::make_unique<ExplicitRun>(Options::from(values), scene);
}

} // namespace bonds
