#include "bonds_solver.h"

#include "equilibrium/modal_run.h"
#include "equilibrium/static_run.h"
#include "explicit/explicit_run.h"
#include "implicit/implicit_run.h"

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

enum class Asked { motion, implicitMotion, balance, modes };

Asked askedOf(std::string_view analysis, const Options &options)
{
   if (analysis == "dynamics")
      return options.integrator == Options::Integrator::implicit ? Asked::implicitMotion : Asked::motion;
   if (analysis == "statics")
      return Asked::balance;
   if (analysis == "modes")
      return Asked::modes;
   throw Failure(DIATOM_UNSUPPORTED,
                 "the analysis \"" + std::string(analysis) + "\" is not one of this solver's");
}

} // namespace

void BondsSolver::estimate(sdk::Call call, sdk::Values values, const sdk::SceneView &scene,
                           diatom_estimate &estimate)
{
   const Options options = Options::from(values);
   switch (askedOf(scene.analysis(), options)) {
   case Asked::motion:
      return ExplicitRun::estimate(call, options, scene, estimate);
   case Asked::implicitMotion:
      return ImplicitRun::estimate(options, scene, estimate);
   case Asked::balance:
      return StaticRun::estimate(options, scene, estimate);
   case Asked::modes:
      return ModalRun::estimate(options, scene, estimate);
   }
}

BondsSolver::BondsSolver(sdk::Call call, sdk::Values values, const sdk::SceneView &scene)
{
   const Options options = Options::from(values);
   switch (askedOf(scene.analysis(), options)) {
   case Asked::motion: {
      auto run = std::make_unique<ExplicitRun>(call, options, scene);
      call.report(DIATOM_INFO, run->how());
      m_analysis = std::move(run);
      break;
   }
   case Asked::implicitMotion:
      m_analysis = std::make_unique<ImplicitRun>(options, values, scene);
      break;
   case Asked::balance:
      m_analysis = std::make_unique<StaticRun>(options, values, scene);
      break;
   case Asked::modes:
      m_analysis = std::make_unique<ModalRun>(options, values, scene);
      break;
   }
}

} // namespace bonds
