/// A trial's picture in a headset.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/clock.hpp"
#include "station/headset/figures.hpp"
#include "station/view/view.hpp"

namespace tractus::headset {

/// Where the probe is just now.
struct Moment {
  view::ProbeState state;
  math::Vec3 tip_m;  ///< in V
};

/// Takes over the counts of a box of the bone that was drilled, and all that was worn; the volume
/// is the scene's.
using TakeBone = std::function<void(const volume::Box& box, const volume::Volume& bone,
                                    const drilling::ErodedShares& worn)>;

/// What is to be shown, and where in the room.
struct Shown {
  view::Scene scene;
  math::Pose X_VD;                 ///< the device in the volume, the model's offset left out
  std::optional<math::Pose> X_SD;  ///< the device in the room (alignment.hpp); else it is taken to
                                   ///< stand before the person
  std::function<std::optional<Moment>()> latest;  ///< asked once a frame, from the headset's thread
  /// Asked once a frame as well: calls back when the bone has changed. Empty: it does not.
  std::function<void(const TakeBone& take)> carved = {};
};

enum class DisplayState {
  waiting,        ///< the runtime has not asked for frames yet, or shows something else
  shown,          ///< somebody sees the scene
  tracking_lost,  ///< somebody sees words that say so
  over,           ///< for good; `why` says why
};

/// All of it: instance, context, session, pictures. Made, used and destroyed by one thread, never
/// the loop's.
class Headset {
 public:
  /// Errors: unavailable, one line: no runtime, no headset, no OpenGL.
  static core::Result<std::unique_ptr<Headset>> make(const Shown& shown, const core::Clock& clock);
  ~Headset();

  /// One frame at the runtime's pace, or none when it asks for none: then it returns at once and
  /// the caller takes a breath. False when it is over.
  bool step();
  /// The session is to end; `step` goes on until it has.
  void ask_to_leave();
  DisplayState seen() const;
  bool running() const;
  const std::string& why() const;
  Figures figures() const;

 private:
  struct Parts;
  explicit Headset(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::headset
