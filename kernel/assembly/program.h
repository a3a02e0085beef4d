// From an order of placing to a machine-neutral pick and place program: feeders, heights, moves, time.
#pragma once

#include "assembly/motion.h"
#include "assembly/plan.h"

#include <functional>
#include <string>
#include <vector>

namespace diatom {

/// What a feeder holds: parts that are alike and lie alike. A machine without a turning axis cannot turn a
/// part, so each direction of a brick comes from a feeder of its own.
struct Stock
{
   std::string label; // for people and for comments in programs
   std::int64_t parts = 0;
   double tallest = 0; // m
};

/// Where one part is fetched and put, as positions of the tool.
struct Placing
{
   std::int64_t part = 0; // of the decomposition
   std::int32_t feeder = 0;
   std::int64_t turn = 0; // how many this feeder gave before
   Vec3 target = Vec3::Zero();
   double height = 0; // of the part, m
};

/// The whole job laid out on the machine, checked against its feeders and ranges before anything is written.
struct Layout
{
   std::vector<Stock> stocks; // by feeder
   std::vector<Placing> placings;
   double feederTop = 0;                            // highest thing in the feeders in use, m
   std::vector<std::int32_t> partFeeder, partIndex; // columns of diatom_program
};

Result<Layout> layOut(const Hierarchy &hierarchy, const Decomposition &parts, const AssemblyPlan &plan,
                      const diatom_machine_description &machine);

/// Takes one piece of a program; stops the writing on an error.
using PieceSink = std::function<Status(const diatom_program &)>;

struct ProgramLength
{
   double pathMetres = 0, seconds = 0;
};

/// Streams the program of a layout in pieces of a fixed number of placings.
Result<ProgramLength> writeProgram(const Layout &layout, const diatom_machine_description &machine,
                                   const std::string &name, const PieceSink &sink, const Job &job);

} // namespace diatom
