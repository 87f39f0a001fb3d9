#include "rules2012.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pilot.hpp"

namespace thicket {

void Rules2012::begin() {
  doing_ = Doing::aligning;
  turned_ = 0.0;
  time_ = -1.0;
}

Rules2012::Pressed Rules2012::groups(const BumperRing& bumpers, double sense) {
  Pressed pressed;
  pressed.ahead = std::numeric_limits<double>::infinity();
  const double border = radians(60.0) - 1e-9;
  for (const Bumper& bumper : bumpers.bumpers()) {
    const double off = std::abs(bumper.centre);
    if (off < border) pressed.front = pressed.front || bumper.pressed;
    else if (off > pi - border) pressed.back = pressed.back || bumper.pressed;
    else if (bumper.centre * sense > 0.0) pressed.side = pressed.side || bumper.pressed;
    if (off < border && std::abs(bumper.bearing) < 0.25 * pi) pressed.ahead = std::min(pressed.ahead, bumper.distance);
  }
  return pressed;
}

Rules2012::Doing Rules2012::next(const Pressed& pressed) const {
  switch (doing_) {
    case Doing::aligning:
      return pressed.side && !pressed.front && !pressed.back ? Doing::along : Doing::aligning;
    case Doing::away_from_front:
      // Released, and the back pressed instead. Where the wall is too far behind for that, the side alone is as good as aligned.
      if (!pressed.front && (pressed.back || pressed.side)) return Doing::along;
      return pressed.front ? Doing::away_from_front : Doing::toward_side;
    case Doing::along:
    case Doing::toward_side:
      break;
  }
  if (pressed.front) return Doing::away_from_front;
  return pressed.side ? Doing::along : Doing::toward_side;
}

Command Rules2012::follow(const Senses& senses, Hand hand) {
  const double sense = hand == Hand::left ? 1.0 : -1.0;  // of a turn toward the wall
  const Pressed pressed = groups(senses.bumpers, sense);
  if (time_ >= 0.0) turned_ += std::abs(senses.turn_rate) * (senses.time - time_);
  time_ = senses.time;
  // Aligning ends, too, when the wall has gone from all bumpers: there is nothing to align with.
  if (doing_ == Doing::aligning && !pressed.front && !pressed.side) doing_ = Doing::toward_side;
  else doing_ = next(pressed);

  const double gentle = std::min(vehicle_.turn_rate, std::max(0.3, 0.25 * vehicle_.turn_acceleration));
  const double room = std::max(0.0, pressed.ahead - clearance_ - senses.speed * vehicle_.decision_period);
  const double speed = std::min(speed_, std::sqrt(2.0 * vehicle_.deceleration * room));
  switch (doing_) {
    case Doing::aligning:
    case Doing::away_from_front:
      return {0.0, -sense * gentle};
    case Doing::along:
      turned_ = 0.0;
      return {speed, 0.0};
    case Doing::toward_side:
      break;
  }
  turned_ = 0.0;
  const double arc = vehicle_.hull_radius + senses.bumpers.press_distance();
  const double slow = std::min(0.5 * speed_, speed);
  return {slow, sense * std::min(vehicle_.turn_rate, slow / (0.7 * arc))};
}

const char* Rules2012::state() const {
  switch (doing_) {
    case Doing::aligning: return "2012: aligning with the boundary";
    case Doing::along: return "2012: driving along the boundary";
    case Doing::toward_side: return "2012: moving toward the boundary";
    case Doing::away_from_front: return "2012: turning away from a corner";
  }
  return "";
}

}  // namespace thicket
