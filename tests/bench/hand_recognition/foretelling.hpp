/// What an ideal observer with the SIMULATED hand's own senses would be right about.
#pragma once

#include "bench/hand_recognition/forms.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus::bench {

/// A whole tract and its fields, palpated by the certificate's observer.
class Foretelling {
 public:
  /// Ends the program when its field cannot be made.
  explicit Foretelling(const Form& whole);

  cases::Palpated palpated(const Form& form) const;
  /// Of a breach under these senses, as cases::Observer::foretold.
  double share_right(const Form& form, const cases::Palpated& palpated,
                     const devices::HandSense& sense) const;

 private:
  cases::Observer observer_;
  cases::Palpated palpated_;
};

}  // namespace tractus::bench
