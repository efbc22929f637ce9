#include <CLI/CLI.hpp>
#include <iostream>
#include <vector>

#include "sim/prepare/prepare.h"

int main(int argc, char** argv) {
  nbs::RunRequest request;
  CLI::App app("Checks what a run is asked to do and makes its folder: run.yaml, streams/, logs/.", "nbs-prepare");
  CLI::Option* object = app.add_option("--object", request.object, "statue, or a mesh file: PLY, STL or OBJ in metres");
  object->capture_default_str();
  std::vector<double> box_m;
  app.add_option("--box", box_m, "X,Y,Z: a real object, which fits in a box of these sizes in metres")
      ->delimiter(',')
      ->expected(3)
      ->excludes(object);
  app.add_option("--method", request.method, "BH/IG, B/IG, B, S/IG or S")->capture_default_str();
  app.add_option("--gain", request.gain,
                 "Gain rule: surface, sum, near_surface, mean, per_second, unknown_count; default: the method's own");
  app.add_option("--cell", request.cell, "Name of a cell, or a cell file")->capture_default_str();
  app.add_option("--cells-dir", request.cells_dir, "Folder of the named cells")->default_val(NBS_CELLS_DIR);
  app.add_option("--completeness", request.completeness, "Wanted mesh completeness")->capture_default_str();
  app.add_option("--max-scans", request.max_scans, "Ends after so many scans")->capture_default_str();
  app.add_option("--seed", request.seed, "Seed of everything random")->capture_default_str();
  app.add_option("--rate", request.rate, "max or realtime")->capture_default_str();
  app.add_option("--out", request.out, "The run folder to be made");
  app.add_option("--version", request.version, "Version of the software, for the record");
  bool list_methods = false;
  app.add_flag("--list-methods", list_methods,
               "Prints the methods, each with what ends its runs, and does nothing else");
  try {
    app.parse(argc, argv);
    if (list_methods) {
      std::cout << nbs::ListMethods();
      return 0;
    }
    if (!box_m.empty()) request.box_m = {box_m.at(0), box_m.at(1), box_m.at(2)};
    nbs::PrepareRun(request);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::Error& error) {
    std::cerr << "nbs-prepare: " << error.what() << " (see nbs-prepare --help)\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "nbs-prepare: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
