#include "services/mesher/remesh.h"

#include <algorithm>

#include "services/mesher/scan_registration.h"
#include "services/mesher/streaming_mesher.h"

namespace nbs {

std::vector<Stripe> KeepWholeScans(std::vector<Stripe> stripes) {
  const auto last = std::ranges::find_if(stripes.rbegin(), stripes.rend(), &Stripe::end_of_scan);
  stripes.erase(last.base(), stripes.end());
  return stripes;
}

Registered Remesh(const Profiler& profiler, std::vector<Stripe> stripes) {
  StreamingMesher mesher(profiler, {});
  Registered registered;
  for (Stripe& stripe : MakeRegisteredStripes(profiler, std::move(stripes))) {
    mesher.AddStripe(stripe);
    registered.stripes.emplace_back(std::move(stripe));
  }
  registered.mesh.emplace_back(mesher.TakeDelta());
  registered.mesh.emplace_back(mesher.CalcScanFigures());
  return registered;
}

}  // namespace nbs
