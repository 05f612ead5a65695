/// All numbers of the lab that are neither data nor physics, in one place. The last word of each
/// comment says how the number was set:
///   derived   follows from the formula that is given
///   numeric   keeps a numerical method well behaved
///   bound     bounds memory, time or the length of an answer
///   physical  an estimate of the apparatus or of a hand
///   prior     what is believed before the data speak, wide against what a recording tells
///   tuned     chosen on simulated development sets (tests/blind), not derived
///   custom    a customary level of significance
#pragma once

#include <array>
#include <cstddef>

#include "lab/settings_discovery.hpp"
#include "lab/settings_selection.hpp"
#include "lab/settings_smoothing.hpp"

namespace tractus::lab {

/// Phases of a recording.
struct PhasesSettings {
  /// A sample this near to a reversal belongs to it. Tuned.
  double near_reversal_s = 0.1;
  /// Slower than this share of the brisk speed counts as holding. Tuned.
  double slow_share = 1.0 / 30.0;
  /// And slower than this, m/s or rad/s. Physical.
  double least_speed = 2e-5;
  /// Palpation: less is no contact. Physical.
  double least_force_N = 0.05;
  /// Palpation: a slower tip is still. Physical.
  double still_m_s = 0.002;
};

/// The low-pass filter before thinning.
struct DecimationSettings {
  /// Cut-off, as a share of the rate after thinning. Numeric.
  double cutoff = 0.35;
  /// Half the filter's length, in periods of the rate after thinning. Numeric.
  double half_periods = 2.2;
  /// A recording that is faster than needed by less than this is not thinned. Bound.
  double least_factor = 1.5;
};

/// How a probing is prepared.
struct ProbingRecordingSettings {
  /// A shorter recording is refused. Tuned.
  std::size_t fewest_samples = 60;
  /// A slower recording is refused. Tuned.
  double slowest_rate_Hz = 50.0;
  /// The rate at which residuals are compared: neighbours are nearly independent. Tuned.
  double thin_rate_Hz = 100.0;
  /// A fit predicts the force no more often than it need, every n-th sample of what was recorded faster than twice this.
  /// Bound.
  double least_fit_rate_Hz = 800.0;
  /// A sample is at rest below so many standard errors of its speed. Tuned.
  double rest_errors = 3.0;
  /// Time round a layer's border that is not judged at the full rate. Tuned.
  double border_s = 0.005;
  /// Or so many samples, if that is longer. Tuned.
  std::size_t border_samples = 3;
  /// A sample this near to a border may lie on either side. Physical.
  double on_border_m = 2e-6;
  /// A probe that stays within this stands. Tuned.
  double same_place_m = 3e-5;
  /// After standing so long it is looked at ever more rarely. Tuned.
  double long_stand_s = 2.0;
  /// The motion is well known where its noise makes less than this share of the sensor's. Tuned.
  double well_known_share = 0.5;
  /// At least this share of the samples, the best known ones, is judged. Tuned.
  double least_judged_share = 0.3;
  /// A residual in whose filter so much is of standstill may hold any dry friction. Tuned.
  double least_moving_rest = 0.05;
  /// The longest a model may be: the recording itself says how far it went. Bound.
  double longest_model_m = 1.0;
  /// Samples of a set that are used. Bound.
  std::size_t most_samples = 600'000;
  /// Samples that each trial of a thinned set keeps at least. Bound.
  std::size_t least_kept_samples = 200;
};

/// Speeds and places that an effect's start values depend on.
struct ProbingStatisticsSettings {
  /// One sample of so many is read: neighbours move alike. Bound.
  std::size_t every_samples = 7;
  /// Stands for the speed of a recording that only rests. Numeric.
  double never_moved_m_s = 1e-3;
  /// The quantile of the speeds that counts as slow. Tuned.
  double slow_quantile = 0.02;
  /// And as fast. Tuned.
  double fast_quantile = 0.9;
};

/// How well a probing model's numbers are believed before the data speak, and how far they may
/// move.
struct ProbingPriorSettings {
  /// Of the logarithm of a stiffness or damping. Prior.
  double factor_sd = 0.5;
  /// Of the place of a border or of rest. Prior.
  double place_sd_m = 5e-4;
  /// Step of finite differences in a place. Numeric.
  double place_step_m = 2e-5;
  /// A border is also sought by trial within this: the loss is rough in it. Tuned.
  double rough_m = 4e-4;
  /// A border this near to the recorded depths may be moved by the fit. Tuned.
  double near_m = 1e-3;
  /// Borders nearer than this are one. Numeric.
  double same_border_m = 1e-9;
  /// The thinnest layer that a fit may leave. Physical.
  double least_layer_m = 1e-4;
  /// A stiffness or damping is sought within this factor of its start. Prior.
  double most_factor = 50.0;
  /// The force may be recorded late or early by this, or by one sample if that is longer, without an effect being
  /// missing: filters and clocks of a sensor. Standard deviation: half of it. Prior.
  double most_delay_s = 2.5e-3;
};

/// How a palpation is prepared.
struct PalpationRecordingSettings {
  /// A shorter recording is refused. Tuned.
  std::size_t fewest_samples = 60;
  /// A slower recording is refused. Tuned.
  double slowest_rate_Hz = 40.0;
  /// A faster recording is thinned to this after smoothing. Bound.
  double fastest_Hz = 250.0;
  /// Acceleration is that of means over so long: a tracker's noise is alike within it, and hands move at less than a
  /// quarter of its rate. Physical.
  double acceleration_of_means_s = 0.02;
};

/// What a fit of palpations compares.
struct PalpationFitSettings {
  /// Equilibria are assigned to the samples and the model fitted so many times in turn. Tuned.
  int rounds = 2;
  /// Samples prepared of all trials together. Bound.
  std::size_t most_samples = 400'000;
  /// Moments compared of all trials together. Bound.
  std::size_t most_instants = 4000;
  /// And no more than so many a second of a trial. Bound.
  double instants_Hz = 100.0;
  /// Samples from which noise is estimated anew. Bound.
  std::size_t least_for_noise = 100;
  /// The motion's noise does nothing where its squares are below this share of the sensor's. Prior.
  double motion_does_nothing = 0.1;
  /// And most where they are above this share. Prior.
  double motion_does_most = 1.0;
  /// Where they are not, so much of the samples, those where it does more, tells how large it is. Prior.
  double telling_share = 0.2;
};

/// How the motion's errors weigh on a palpation's samples, and which equilibrium the shank was in.
struct PalpationWeightsSettings {
  /// At least this share of the samples, the best known ones, is judged. Tuned.
  double least_judged_share = 0.3;
  /// A sample of which more than this factor of the sensor's noise is not known is not judged. Tuned.
  double poorly_known_factor = 4.0;
  /// Less force at a point is no contact. Physical.
  double contact_N = 0.05;
  /// Under more force it is told from the recording how much of it friction and losses are. Tuned.
  double pressed_N = 0.3;
  /// They are assumed to be at least this share of the contact force. Prior.
  double least_loss_share = 0.02;
  /// And at most this one. Prior.
  double most_loss_share = 0.3;
  /// The mass with which a probe's inertia is assumed to act before the recordings say. Prior.
  double mass_kg = 0.02;
  /// What is felt so near to the volume's edge is not known. Physical.
  double edge_voxels = 2.0;
  /// The shank has snapped if its deflection changed by more than this times what the hand moved.
  /// Tuned.
  double snap_ratio = 2.0;
  /// Plus this. Tuned.
  double snap_m = 3e-5;
  /// The moment of a snap is known within this. Tuned.
  double snap_known_s = 0.015;
  /// Equilibria nearer than this are one. Numeric.
  double same_equilibrium_m = 2e-6;
  /// Equilibria further apart than this are several. Numeric.
  double other_equilibrium_m = 1e-5;
  /// What a change of equilibrium must save, in squares of the usual error. Tuned.
  double change_cost = 4.0;
  /// A sample counts at most as so many usual errors. Tuned.
  double most_errors = 5.0;
  /// Equilibria that are tried: from the last sample, from rest, and reached backwards in time.
  /// Numeric.
  std::size_t candidates = 3;
  /// Step of finite differences in a place. Numeric.
  double place_step_m = 2e-6;
  /// And in an angle. Numeric.
  double turn_step_rad = 2e-5;
};

/// How well a palpation model's numbers are believed before the data speak, and how far they may
/// move. They decide only what a recording leaves open: force factor and scales are felt in two
/// products, modulus and radius in one.
struct PalpationPriorSettings {
  /// Of the logarithm of a factor. Prior.
  double factor_sd = 0.25;
  /// Of the logarithm of the shank's radius, which counts four times. Prior.
  double radius_sd = 0.1;
  /// Of a length that a ruler measured. Prior.
  double length_sd_m = 5e-4;
  /// A factor is sought within this factor of its start. Prior.
  double most_factor = 20.0;
  /// The force may be late or early by this without an effect being missing. Prior.
  double most_delay_s = 2.5e-3;
  /// Step of finite differences in a logarithm; where a step takes a sample's shank from one
  /// equilibrium to another, the derivative is the jump over the step: so not too small. Tuned.
  double logarithmic_step = 2e-2;
};

/// Cells of the unrolled wall.
struct TractMapSettings {
  /// Cells along the tract. Bound.
  std::size_t depths = 12;
  /// Cells round it. Bound.
  std::size_t angles = 16;
  /// A cell with fewer samples says nothing. Tuned.
  double least_samples = 5.0;
};

/// Where a search for an effect begins, if its facts do not say.
struct StartsSettings {
  /// Nodes of the grid over a logarithmic range. Bound.
  int nodes_logarithmic = 8;
  /// Over a linear range. Bound.
  int nodes_linear = 4;
  /// Start values of an effect at most. Bound.
  std::size_t most_starts = 64;
  /// Step of finite differences: share of the initial value, or change of its logarithm. Numeric.
  double step = 0.01;
};

/// The robust Levenberg–Marquardt method.
struct LeastSquaresSettings {
  /// Huber's threshold, in standard deviations. Tuned.
  double huber = 4.0;
  /// The scale is taken at this quantile of |residual|, where only single samples lie beyond.
  /// Tuned.
  double scale_quantile = 0.97;
  /// That quantile of |z|, z standard normal. Derived.
  double scale_of_normal = 2.17;
  /// Directions below this share of the greatest eigenvalue, columns scaled to one, are unknown.
  /// Numeric.
  double rank = 1e-11;
  /// Rounds of the search by trial for rough parameters. Bound.
  int rough_rounds = 3;
  /// Ever shorter steps from one point. Bound.
  int most_tries = 12;
  /// The finest step of that search, as a share of its range. Bound.
  double finest_rough = 0.001;
  /// A rough parameter that lowers the loss, 2 nats, by no more than this keeps its given value: three standard errors.
  /// Prior.
  double given_place = 9.0;
};

/// The linear screen of an effect.
struct ScreenSettings {
  /// A smaller mean square, in units of the noise, is no response. Numeric.
  double no_response = 1e-12;
  /// A smaller share of its own is none. Numeric.
  double no_share = 1e-7;
  /// The strength to begin with, as a share of the start's, if the screen finds none. Numeric.
  double first_strength = 0.05;
};

/// A mass is felt in free air as well.
struct FreeAirSettings {
  /// An effect of whose mean square less than this share is in free air is not held against it. Tuned.
  double least_share = 0.05;
  /// What is not seen there by this share is not named: of true masses 0.9 to 1.2 show, of noise up to 0.53. Tuned.
  double least_shown = 0.7;
};

/// A drift that follows the motion is no sensor's.
struct DriftOnMotionSettings {
  /// Time constants of the motion's memory that is held against the drift. Physical.
  std::array<double, 3> memories_s{0.5, 2.0, 8.0};
  /// Plays whose side tells the direction of the last motion, as shares of the way's range. Physical.
  std::array<double, 2> play_shares{0.001, 0.01};
  /// Moments of a trial that are compared. Bound.
  std::size_t rows_per_trial = 400;
};

/// Whether what is left can be predicted from the recorded signals.
struct DependenceSettings {
  /// Knots of the curve over a signal. Numeric.
  int knots = 32;
  /// Knots of a surface over two, along each. Numeric.
  int knots_of_pair = 6;
  /// So many of the signals that predict most alone are taken in pairs. Bound.
  std::size_t paired = 6;
  /// Functions in a sum at most. Bound.
  std::size_t most_functions = 4;
  /// A further function must take away this share more. Bound.
  double least_more = 0.005;
  /// Functions are chosen without a group of trials and judged by it; so many groups. Bound.
  std::size_t groups = 4;
  /// Blocks of neighbouring samples of a trial. Bound.
  std::size_t blocks_per_trial = 800;
  /// A block is no longer than the motion takes for this part of a period, by its velocity's and acceleration's mean
  /// squares: of 10 ms of an oscillation of 70 Hz the mean says nothing. Numeric.
  double longest_block_rad = 0.5;
  /// Time constants of the velocity's memory. Physical.
  std::array<double, 3> memories_s{0.03, 0.15, 0.8};
  /// A signal that explains less of the variance is not named. Bound.
  double worth_naming = 0.05;
  /// Signals that are named at most. Bound.
  std::size_t named = 3;
  /// Added to the normal equations' diagonal: a hat is believed to be 0 to within the error of a third of a block. Prior.
  double ridge = 10.0;
};

/// Whether what is left follows a law of physics that the model lacks.
struct LawsSettings {
  /// Time constants of the contact's memory; a shorter one is a matter of when force and pose were recorded. Physical.
  std::array<double, 3> memories_s{0.15, 0.8, 3.0};
  /// Laws that are combined at most. Bound.
  std::size_t most_laws = 3;
  /// A further law must take away this share more. Bound.
  double least_more = 0.003;
  /// Added to the diagonal of the terms' correlations. Numeric.
  double ridge = 1e-3;
  /// Less force has no direction. Physical.
  double least_N = 1e-3;
  /// A slower tip has a less certain direction of friction. Physical.
  double least_speed_m_s = 1e-3;
  /// Less force is no contact. Physical.
  double touch_N = 0.02;
};

/// Checks of an effect that a user wrote.
struct UserEffectsSettings {
  /// An effect whose responses correlate more with another's says the same. Tuned.
  double alike = 0.95;
  /// An effect with less than this share of its response beside the base's numbers adds nothing.
  /// Tuned.
  double least_own = 0.02;
  /// At its off value an effect may change the residual by this share of its size. Numeric.
  double neutral = 1e-9;
};

/// Regions that hold the error.
struct RegionsSettings {
  /// Stretches of a single trial, every other one for borders. Tuned.
  std::size_t stretches = 40;
  /// Round numbers inside a feature's range that a border may take. Bound.
  std::size_t most_edges = 40;
};

/// Readable features of each moment.
struct DescriptionSettings {
  /// Moments that are described. Bound.
  std::size_t most_rows = 400'000;
  /// A palpation sensor's noise if the recording cannot tell [Zoller2020]. Physical.
  double sensor_noise_N = 0.01;
};

/// Distributions of an error.
struct ComparisonSettings {
  /// Bins of a histogram. Bound.
  std::size_t bins = 48;
  /// Samples from which quantiles are taken. Bound.
  std::size_t most_for_quantiles = 200'000;
};

/// Log odds that a model lacks a material effect, linear in what it leaves. Fitted by tests/hidden_physics/benchmark/calibrate.py
/// to the answers to the first 110 probing sets of the development generation "january", and to 131 palpation sets of
/// "june" to "august".
struct MoreMissingOdds {
  /// Where the held-out error is at the noise floor and no signal predicts any of it. Tuned.
  double at_floor;
  /// For each factor e of the error over the floor. Tuned.
  double per_log_error;
  /// For all of the error's mean square predicted by recorded signals. Tuned.
  double per_share;
  /// For all of the judged squares that laws of physics predict, where the rig has such. Tuned.
  double per_law_share = 0.0;
};

/// Thresholds of the selection on a rig, as mean squares of the whitened residual: how near to 1 a
/// true model comes there. All tuned.
struct SelectionThresholds {
  /// Below this no further effect is looked for,
  double stop_below;
  /// nor if the given model is below this and no effect betters it.
  double stop_if_given_below;
  /// Share of the mean square that a further effect must take away,
  double least_gain_share;
  /// and share of the given model's excess.
  double least_gain_of_excess;
  /// Independent observations that a trial is worth when structures are compared: far below the number of samples, for
  /// what separates structures is small flaws of any model, which all samples of a trial share.
  double observations_per_trial;
  /// A trend of which the motion's memory explains this share is no sensor's; above 1: never asked.
  double drift_r2_on_motion;
  /// Errors that all trials have in common (of the motion, of the sensor) do not show in how far the trials disagree:
  /// standard errors are larger by this factor. Fitted to labelled answers so that intervals of 90 % hold 90 %.
  double common_errors;
  MoreMissingOdds more;

  constexpr SelectionThresholds with(MoreMissingOdds other) const {
    SelectionThresholds out = *this;
    out.more = other;
    return out;
  }
};

/// The lab's settings, by stage.
struct Settings {
  SelectionThresholds probing_thresholds{.stop_below = 1.25,
                                         .stop_if_given_below = 0.0,
                                         .least_gain_share = 0.12,
                                         .least_gain_of_excess = 0.004,
                                         .observations_per_trial = 12.0,
                                         .drift_r2_on_motion = 0.45,
                                         .common_errors = 1.25,
                                         .more = {-3.4, 5.9, 6.6}};
  SelectionThresholds torque_thresholds = probing_thresholds.with({-5.5, 3.8, 6.6});
  SelectionThresholds palpation_thresholds{.stop_below = 0.9,
                                           .stop_if_given_below = 1.1,
                                           .least_gain_share = 0.01,
                                           .least_gain_of_excess = 0.0,
                                           .observations_per_trial = 60.0,
                                           .drift_r2_on_motion = 0.15,
                                           .common_errors = 1.7,
                                           .more = {-2.06, 5.73, 11.7, 23.0}};
  SmoothingSettings smoothing;
  PhasesSettings phases;
  DecimationSettings decimation;
  ProbingRecordingSettings probing_recording;
  ProbingStatisticsSettings probing_statistics;
  ProbingPriorSettings probing_prior;
  PalpationRecordingSettings palpation_recording;
  PalpationFitSettings palpation_fit;
  PalpationWeightsSettings palpation_weights;
  PalpationPriorSettings palpation_prior;
  TractMapSettings tract_map;
  StartsSettings starts;
  LeastSquaresSettings least_squares;
  ScreenSettings screen;
  SelectionSettings selection;
  PosteriorSettings posterior;
  ValidationSettings validation;
  DiagnosisSettings diagnosis;
  FreeAirSettings free_air;
  DriftOnMotionSettings drift_on_motion;
  LawsSettings laws;
  DependenceSettings dependence;
  GrammarSettings grammar;
  DiscoverySettings discovery;
  UserEffectsSettings user_effects;
  RegionsSettings regions;
  DescriptionSettings description;
  ComparisonSettings comparison;
};

inline constexpr Settings kSettings{};

}  // namespace tractus::lab
