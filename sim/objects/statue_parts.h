#pragma once

#include "sim/objects/sculptor.h"

namespace nbs {

// The parts of the statue, in millimetres, in the order in which they are built. The figure faces -y; its left side is
// +x. Sole of the feet near z = 54, top of the head near z = 412.

void SculptPlinth(Sculptor& s);
void SculptLegs(Sculptor& s);
void SculptTorso(Sculptor& s);
void SculptArms(Sculptor& s);
void SculptBowl(Sculptor& s);
void SculptHead(Sculptor& s);
void SculptHair(Sculptor& s);
void SculptCloth(Sculptor& s);
void SculptWings(Sculptor& s);

}  // namespace nbs
