// Following a boundary by the rules of Rozeboom 2012, section 5.2, on bumpers alone. Private to the room.
#pragma once

#include "thicket/nav/planner.hpp"

namespace thicket {

enum class Hand;  // pilot.hpp

/// The text's rules, literally, for comparison with the follower that looks at single rays:
/// - the robot aligns itself with the boundary: it turns until only a side bumper is pressed, the one of the hand on the wall;
/// - it drives along until the state of a bumper changes;
/// - the side bumper is released: too far away, it moves toward that side until it is pressed again;
/// - the front bumper is pressed: a corner; it turns away from the side until the front is released, and the back is pressed instead.
/// With four bumpers these are the four. With more, front and back are all whose middle is less than 60 degrees from straight ahead and behind, the sides the others.
/// Not in the text, for a vehicle has to have them: it brakes for what is nearer ahead than it can stop for, and it moves toward the side along an arc as wide as the bumpers reach.
class Rules2012 {
 public:
  /// `speed`: cruising speed, m/s. `clearance`: to matter ahead it brakes to this distance from the hull, m.
  Rules2012(const VehicleLimits& vehicle, double speed, double clearance) : vehicle_(vehicle), speed_(speed), clearance_(clearance) {}

  /// At a new boundary: align first.
  void begin();
  Command follow(const Senses& senses, Hand hand);

  /// What it does, in words.
  const char* state() const;
  /// It has turned once around without finding a way to align: the bumpers are pressed on all sides.
  bool boxed_in() const { return turned_ > 2.0 * pi; }

 private:
  enum class Doing { aligning, along, toward_side, away_from_front };
  /// Which groups of bumpers are pressed.
  struct Pressed {
    bool front = false, back = false, side = false;
    double ahead = 0.0;  ///< from the hull to the nearest matter before it, m
  };
  static Pressed groups(const BumperRing& bumpers, double sense);
  Doing next(const Pressed& pressed) const;

  VehicleLimits vehicle_;
  double speed_, clearance_;
  Doing doing_ = Doing::aligning;
  double turned_ = 0.0;  ///< on the spot since it last drove, rad
  double time_ = -1.0;   ///< of the last call, s
};

}  // namespace thicket
