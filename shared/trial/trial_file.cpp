#include "trial/trial_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <optional>

#include "core/try.hpp"
#include "trial/frame_writer.hpp"
#include "trial/frames.hpp"
#include "trial/packing.hpp"
#include "trial/trial_reader.hpp"

namespace tractus {
namespace trial {
namespace {
using OnSamples = std::function<void(const Block&)>;

/// Takes the frames of one file in order and holds them against the rules of the format.
class Scanner {
 public:
  Scanner(FrameReader& reader, const ReadLimits& limits) : reader_(reader), limits_(limits) {}

  /// Reads until there is a block of samples (Step::frame), or to the end, to the torn rest or to
  /// the first thing wrong. Returns how it stopped.
  core::Result<FrameReader::Step> next();
  /// The samples of the frame that was read last.
  Block block() const { return {block_, probing_}; }

  Trial take_trial() { return std::move(trial_); }
  const Trial& trial() const { return trial_; }
  std::uint64_t samples() const { return samples_; }
  double last_s() const {
    const double sample_s = last_ ? last_->t_s : last_probing_ ? last_probing_->t_s : 0.0;
    return trial_.events.empty() ? sample_s : std::max(sample_s, trial_.events.back().t_s);
  }

 private:
  core::Error wrong(core::Errc code, const std::string& what) const {
    return frame_error(code, reader_.path(), reader_.offset(), what);
  }
  core::Result<core::Json> take_json(const char* what) const;
  core::Result<void> take_frame();
  core::Result<void> take_header();
  core::Result<void> take_samples();
  template <class S>
  core::Result<void> take_plain(std::vector<S>& block) const;
  template <class S>
  core::Result<void> take_samples_of(std::vector<S>& block, std::optional<S>& last);
  core::Result<void> take_event();
  core::Result<void> take_end();

  FrameReader& reader_;
  ReadLimits limits_;
  Trial trial_;
  std::vector<Sample> block_;
  std::vector<ProbingSample> probing_;
  std::optional<Sample> last_;
  std::optional<ProbingSample> last_probing_;
  std::uint64_t samples_ = 0;
  std::size_t events_bytes_ = 0;
  Packer packer_;
  bool has_header_ = false;
};

core::Result<FrameReader::Step> Scanner::next() {
  for (;;) {
    auto step = reader_.next();
    if (!step) return step;
    if (*step != FrameReader::Step::frame) {
      if (!has_header_) return wrong(core::Errc::corrupt, "the file holds no whole header");
      return step;
    }
    TRY(take_frame());
    if (reader_.type() == FrameType::samples || reader_.type() == FrameType::packed) return step;
    if (!trial_.sealed) continue;
    if (const auto rest = reader_.size() - reader_.position(); rest > 0)
      return wrong(core::Errc::corrupt, fmt::format("{} bytes after the end frame", rest));
    return FrameReader::Step::end;
  }
}

core::Result<void> Scanner::take_frame() {
  if (has_header_ == (reader_.type() == FrameType::header))
    return wrong(core::Errc::corrupt, has_header_ ? "a second header" : "the header is missing");
  switch (reader_.type()) {
    case FrameType::header:
      return take_header();
    case FrameType::samples:
    case FrameType::packed:
      return take_samples();
    case FrameType::event:
      return take_event();
    case FrameType::end:
      return take_end();
  }
  return wrong(core::Errc::corrupt, "frame of unknown type");
}

core::Result<core::Json> Scanner::take_json(const char* what) const {
  const auto payload = reader_.payload();
  if (payload.size() > kMaxJson_bytes)
    return wrong(core::Errc::too_large,
                 fmt::format("{} of {} bytes, at most {}", what, payload.size(), kMaxJson_bytes));
  auto json = core::parse_json(core::text_of(payload), what);
  if (!json) return wrong(json.error().code, json.error().what);
  return json;
}

core::Result<void> Scanner::take_header() {
  auto json = TRY(take_json("header"));
  auto header = Header::from_json(json, "header");
  if (!header) return wrong(header.error().code, header.error().what);
  trial_.header = std::move(header).value();
  has_header_ = true;
  return {};
}

core::Result<void> Scanner::take_samples() {
  if (trial_.header.rig == Rig::palpation) return take_samples_of(block_, last_);
  return take_samples_of(probing_, last_probing_);
}

template <class S>
core::Result<void> Scanner::take_plain(std::vector<S>& block) const {
  const auto payload = reader_.payload();
  std::uint32_t count = 0;
  if (payload.size() >= sizeof count) std::memcpy(&count, payload.data(), sizeof count);
  if (count == 0 || payload.size() != sizeof count + std::uint64_t{count} * sizeof(S))
    return wrong(core::Errc::corrupt,
                 fmt::format("{} samples said, {} bytes given", count, payload.size()));
  block.resize(count);
  std::memcpy(block.data(), payload.data() + sizeof count, count * sizeof(S));
  return {};
}

template <class S>
core::Result<void> Scanner::take_samples_of(std::vector<S>& block, std::optional<S>& last) {
  if (reader_.type() == FrameType::packed) {
    if (auto taken = packer_.unpack(reader_.payload(), block); !taken)
      return wrong(taken.error().code, taken.error().what);
  } else if (auto taken = take_plain(block); !taken) {
    return taken;
  }
  if (samples_ + block.size() > limits_.max_samples)
    return wrong(core::Errc::too_large, fmt::format("more than {} samples", limits_.max_samples));
  const S* before = last ? &*last : nullptr;
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (const auto fault = fault_of(block[i], before); !fault.empty())
      return wrong(core::Errc::bad_input, fmt::format("sample {}: {}", samples_ + i, fault));
    before = &block[i];
  }
  packer_.follow(std::span<const S>(block));
  last = block.back();
  samples_ += block.size();
  return {};
}

core::Result<void> Scanner::take_event() {
  auto json = TRY(take_json("event"));
  auto event = Event::from_json(json, "event");
  if (!event) return wrong(event.error().code, event.error().what);
  events_bytes_ += reader_.payload().size();
  if (events_bytes_ > kMaxEvents_bytes)
    return wrong(core::Errc::too_large,
                 fmt::format("more than {} bytes of events", kMaxEvents_bytes));
  if (!trial_.events.empty() && event->t_s < trial_.events.back().t_s)
    return wrong(core::Errc::bad_input, fmt::format("event: time runs backwards from {} s to {} s",
                                                    trial_.events.back().t_s, event->t_s));
  trial_.events.push_back(std::move(event).value());
  return {};
}

core::Result<void> Scanner::take_end() {
  const auto payload = reader_.payload();
  const auto expected = end_payload(samples_, reader_.take_hash().hex());
  if (payload.size() != expected.size())
    return wrong(core::Errc::corrupt, fmt::format("end frame of {} bytes, expected {}",
                                                  payload.size(), expected.size()));
  std::uint64_t count = 0;
  std::memcpy(&count, payload.data(), sizeof count);
  if (count != samples_)
    return wrong(
        core::Errc::corrupt,
        fmt::format("the end frame counts {} samples, the file holds {}", count, samples_));
  if (std::memcmp(payload.data(), expected.data(), expected.size()) != 0)
    return wrong(core::Errc::corrupt, "the SHA-256 of the file does not hold");
  trial_.sealed = true;
  for (const Event& event : trial_.events) trial_.complete |= event.is(EventKind::end);
  return {};
}

core::Error damaged_last_frame(const FrameReader& reader) {
  return frame_error(core::Errc::corrupt, reader.path(), reader.offset(),
                     "the checksum of a frame's payload does not hold");
}

}  // namespace

struct TrialReader::State {
  State(FrameReader reader, const ReadLimits& limits)
      : frames(std::move(reader)), scanner(frames, limits) {}
  FrameReader frames;
  Scanner scanner;
  bool ended = false;
};

TrialReader::TrialReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
TrialReader::~TrialReader() = default;
TrialReader::TrialReader(TrialReader&&) noexcept = default;
TrialReader& TrialReader::operator=(TrialReader&&) noexcept = default;

core::Result<TrialReader> TrialReader::open(const std::filesystem::path& path,
                                            const ReadLimits& limits) {
  auto frames = TRY(FrameReader::open(path, limits.max_bytes));
  return TrialReader(std::make_unique<State>(std::move(frames), limits));
}

core::Result<std::optional<Block>> TrialReader::next() {
  if (state_->ended) return std::optional<Block>();
  const auto step = TRY(state_->scanner.next());
  if (step == FrameReader::Step::frame) return std::optional(state_->scanner.block());
  if (step == FrameReader::Step::damaged) return damaged_last_frame(state_->frames);
  state_->ended = true;
  return std::optional<Block>();
}

core::Result<Trial> read_trial(const std::filesystem::path& path, const ReadLimits& limits) {
  std::vector<Sample> samples;
  std::vector<ProbingSample> probing;
  auto trial = scan_trial(
      path,
      [&](const Block& block) {
        samples.insert(samples.end(), block.palpation.begin(), block.palpation.end());
        probing.insert(probing.end(), block.probing.begin(), block.probing.end());
      },
      limits);
  if (!trial) return trial;
  trial->samples = std::move(samples);
  trial->probing = std::move(probing);
  return trial;
}

core::Result<Trial> scan_trial(const std::filesystem::path& path, const OnSamples& on_samples,
                               const ReadLimits& limits) {
  auto reader = TRY(FrameReader::open(path, limits.max_bytes));
  Scanner scanner(reader, limits);
  for (;;) {
    const auto step = TRY(scanner.next());
    if (step == FrameReader::Step::damaged) return damaged_last_frame(reader);
    if (step != FrameReader::Step::frame) return scanner.take_trial();
    on_samples(scanner.block());
  }
}

core::Result<std::uint64_t> recover_trial(const std::filesystem::path& path) {
  const ReadLimits limits;
  auto locked = open_locked(path);
  if (!locked) return locked.error();
  auto reader = TRY(FrameReader::open(path, limits.max_bytes));
  Scanner scanner(reader, limits);
  auto step = FrameReader::Step::frame;
  while (step == FrameReader::Step::frame) step = TRY(scanner.next());
  if (scanner.trial().sealed) return scanner.samples();
  if (step == FrameReader::Step::damaged && reader.type() == FrameType::end)
    return frame_error(core::Errc::corrupt, path, reader.offset(),
                       "the checksum of the end frame does not hold");
  const double last_s = scanner.last_s();
  const auto& events = scanner.trial().events;
  const bool said = !events.empty() && events.back().is(EventKind::interrupted);
  auto frames = TRY(FrameWriter::resume(std::move(locked).value(), reader));
  if (!said) {
    const Event event = Event::of(last_s, EventKind::interrupted);
    TRY(frames.append(FrameType::event, json_payload(event.to_json())));
  }
  TRY(frames.seal(scanner.samples()));
  return scanner.samples();
}

}  // namespace trial
}  // namespace tractus
