#include "bonds_solver.h"

#include "equilibrium/modal_run.h"
#include "equilibrium/static_run.h"
#include "explicit/explicit_run.h"

namespace bonds {

using sdk::Failure;

const diatom_capabilities &BondsSolver::capabilities()
{
   static const char *const kPhysics[] = {"mechanics"}, *const kAnalyses[] = {"dynamics", "statics", "modes"},
                            *const kLattices[] = {"*"};
   static const char *const kEffects[] = {"rotation", "damping", "gravity", "actuation", "ground", "friction",
                                          "drag",     "loads",   "driven",  "solid",     "poisson"};
   static const diatom_capabilities kCaps{
       sizeof(diatom_capabilities), 1, 3, kPhysics, kAnalyses, 11, kEffects, 1, kLattices, 1};
   return kCaps;
}

namespace {

enum class Asked { motion, balance, modes };

Asked askedOf(std::string_view analysis)
{
   if (analysis == "dynamics")
      return Asked::motion;
   if (analysis == "statics")
      return Asked::balance;
   if (analysis == "modes")
      return Asked::modes;
   throw Failure(DIATOM_UNSUPPORTED,
                 "the analysis \"" + std::string(analysis) + "\" is not one of this solver's");
}

} // namespace

void BondsSolver::estimate(sdk::Call, sdk::Values values, const sdk::SceneView &scene,
                           diatom_estimate &estimate)
{
   const Options options = Options::from(values);
   switch (askedOf(scene.analysis())) {
   case Asked::motion:
      return ExplicitRun::estimate(options, scene, estimate);
   case Asked::balance:
      return StaticRun::estimate(options, scene, estimate);
   case Asked::modes:
      return ModalRun::estimate(options, scene, estimate);
   }
}

BondsSolver::BondsSolver(sdk::Call call, sdk::Values values, const sdk::SceneView &scene)
{
   const Options options = Options::from(values);
   switch (askedOf(scene.analysis())) {
   case Asked::motion: {
      auto run = std::make_unique<ExplicitRun>(options, scene);
      call.report(DIATOM_INFO, run->how());
      m_analysis = std::move(run);
      break;
   }
   case Asked::balance:
      m_analysis = std::make_unique<StaticRun>(options, values, scene);
      break;
   case Asked::modes:
      m_analysis = std::make_unique<ModalRun>(options, values, scene);
      break;
   }
}

} // namespace bonds
