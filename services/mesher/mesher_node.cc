#include "services/mesher/mesher_node.h"

namespace nbs {

void MesherNode::Handle(const Message& message, Outbox& out) {
  const Stripe& stripe = std::get<Stripe>(message);
  if (!mesher_.AddStripe(stripe)) return;
  if (stripe.end_of_scan) {
    out.push_back(mesher_.TakeDelta());
    out.push_back(mesher_.CalcScanFigures());
  } else if (stripe.index % kStripesPerDelta == kStripesPerDelta - 1) {
    out.push_back(mesher_.TakeDelta());
  }
}

std::vector<Node::Count> MesherNode::Complaints() const {
  return {{"refused stripes", mesher_.counts().refused_stripes},
          {"refused measurements", mesher_.counts().refused_measurements}};
}

}  // namespace nbs
