#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/try.hpp"
#include "trial/frame_writer.hpp"
#include "trial/packing.hpp"
#include "trial/trial_file.hpp"

namespace tractus::trial {
struct TrialWriter::State {
  std::string name;
  FrameWriter frames;
  Rig rig;
  std::optional<Sample> last_sample;
  std::optional<ProbingSample> last_probing;
  double last_event_s = 0.0;
  std::uint64_t samples = 0;
  std::size_t events_bytes = 0;
  Packer packer = {};

  core::Error refused(const std::string& what) const {
    return {core::Errc::bad_input, fmt::format("{}: {}", name, what)};
  }
  template <class S>
  core::Result<void> append(std::span<const S> block, Rig kind, std::optional<S>& last);
};

TrialWriter::TrialWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
TrialWriter::~TrialWriter() = default;
TrialWriter::TrialWriter(TrialWriter&&) noexcept = default;
TrialWriter& TrialWriter::operator=(TrialWriter&&) noexcept = default;

core::Result<TrialWriter> TrialWriter::create(const std::filesystem::path& path,
                                              const Header& header) {
  const auto payload = json_payload(header.to_json());
  if (payload.size() > kMaxJson_bytes)
    return core::Error{core::Errc::too_large,
                       fmt::format("{}: header of {} bytes, at most {}", path.string(),
                                   payload.size(), kMaxJson_bytes)};
  auto json = TRY(core::parse_json(core::text_of(payload), path.string() + ": header"));
  TRY(Header::from_json(json, path.string() + ": header"));
  auto frames = FrameWriter::create(path, payload);
  if (!frames) return frames.error();
  return TrialWriter(std::unique_ptr<State>(
      new State{path.string(), std::move(frames).value(), header.rig, {}, {}, 0.0, 0, 0}));
}

template <class S>
core::Result<void> TrialWriter::State::append(std::span<const S> block, Rig kind,
                                              std::optional<S>& last) {
  if (kind != rig)
    return refused(
        fmt::format("samples of {} in a trial of {}", trial::name(kind), trial::name(rig)));
  const S* before = last ? &*last : nullptr;
  for (const S& sample : block) {
    if (const auto fault = fault_of(sample, before); !fault.empty()) return refused(fault);
    before = &sample;
  }
  while (!block.empty()) {
    const auto part = block.first(std::min(block.size(), max_packed_samples(sizeof(S))));
    TRY(frames.append(FrameType::packed, packer.pack(part)));
    packer.follow(part);
    last = part.back();
    samples += part.size();
    block = block.subspan(part.size());
  }
  return {};
}

core::Result<void> TrialWriter::append(std::span<const Sample> samples) {
  return state_->append(samples, Rig::palpation, state_->last_sample);
}

core::Result<void> TrialWriter::append(std::span<const ProbingSample> samples) {
  return state_->append(samples, Rig::probing, state_->last_probing);
}

core::Result<void> TrialWriter::append(const Event& event) {
  const auto payload = json_payload(event.to_json());
  if (payload.size() > kMaxJson_bytes)
    return state_->refused(
        fmt::format("event of {} bytes, at most {}", payload.size(), kMaxJson_bytes));
  if (state_->events_bytes + payload.size() > kMaxEvents_bytes)
    return state_->refused(fmt::format("more than {} bytes of events", kMaxEvents_bytes));
  auto json = TRY(core::parse_json(core::text_of(payload), state_->name + ": event"));
  auto readable = TRY(Event::from_json(json, state_->name + ": event"));
  if (readable.t_s < state_->last_event_s)
    return state_->refused(fmt::format("event \"{}\" at {} s after one at {} s", readable.kind,
                                       readable.t_s, state_->last_event_s));
  TRY(state_->frames.append(FrameType::event, payload));
  state_->last_event_s = readable.t_s;
  state_->events_bytes += payload.size();
  return {};
}

core::Result<void> TrialWriter::flush() { return state_->frames.flush(); }

core::Result<void> TrialWriter::finish() { return state_->frames.seal(state_->samples); }

std::uint64_t TrialWriter::samples_written() const noexcept { return state_->samples; }

}  // namespace tractus::trial
