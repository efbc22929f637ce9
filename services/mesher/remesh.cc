#include "services/mesher/remesh.h"

#include <iterator>
#include <stdexcept>

#include "services/mesher/scan_registration.h"
#include "services/mesher/streaming_mesher.h"

namespace nbs {

namespace {

/// The stripe that would have closed the scan of the last one.
Stripe MakeClosing(Stripe last) {
  last.end_of_scan = true;
  ++last.index;
  last.ranges_m.clear();
  return last;
}

}  // namespace

Registered Remesh(const Profiler& profiler, std::vector<Stripe> stripes) {
  if (stripes.empty()) throw std::invalid_argument("Remesh: no stripes");
  StreamingMesher mesher(profiler, {});
  Registered registered;
  stripes = MakeRegisteredStripes(profiler, std::move(stripes));
  for (const Stripe& stripe : stripes) mesher.AddStripe(stripe);
  if (!stripes.back().end_of_scan) mesher.AddStripe(MakeClosing(stripes.back()));
  registered.mesh.emplace_back(mesher.TakeDelta());
  registered.mesh.emplace_back(mesher.CalcScanFigures());
  registered.stripes.assign(std::make_move_iterator(stripes.begin()), std::make_move_iterator(stripes.end()));
  return registered;
}

}  // namespace nbs
