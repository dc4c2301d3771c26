// SPDX-License-Identifier: MIT
#include "meltray/observe/checkpoint.hpp"

#include <fmt/format.h>

#include <charconv>

#include "meltray/core/errors.hpp"
#include "meltray/observe/files.hpp"
#include "meltray/observe/hdf5_file.hpp"

namespace meltray::observe {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBlock = 512;  // smallest user block of HDF5
constexpr std::string_view kMagic = "meltray checkpoint\n";
constexpr std::string_view kState = "state/";

class SavingArchive final : public Archive {
 public:
  explicit SavingArchive(std::size_t expected) : expected_(expected) {}
  bool loading() const override { return false; }
  void value(std::string_view name, double& v) override { out().scalar(place(name), v); }
  void value(std::string_view name, std::int64_t& v) override { out().scalar(place(name), v); }
  void value(std::string_view name, std::string& v) override {
    out().scalar(place(name), std::string_view(v));
  }
  void values(std::string_view name, std::vector<double>& v) override { out().dataset(place(name), v); }
  void values(std::string_view name, std::vector<std::uint8_t>& v) override { out().dataset(place(name), v); }
  void values(std::string_view name, std::vector<std::int32_t>& v) override { out().dataset(place(name), v); }

  /// The file takes its memory with the first value: whoever saves may give some back before.
  Hdf5Writer& out() {
    if (!out_) out_.emplace(expected_);
    return *out_;
  }

 private:
  static std::string place(std::string_view name) { return fmt::format("{}{}", kState, name); }

  std::size_t expected_;
  std::optional<Hdf5Writer> out_;
};

class LoadingArchive final : public Archive {
 public:
  LoadingArchive(std::span<const std::byte> image, const std::string& label) : in(image, label) {}
  bool loading() const override { return true; }
  void value(std::string_view name, double& v) override { in.scalar(place(name), v); }
  void value(std::string_view name, std::int64_t& v) override { in.scalar(place(name), v); }
  void value(std::string_view name, std::string& v) override { in.scalar(place(name), v); }
  void values(std::string_view name, std::vector<double>& v) override { in.dataset(place(name), v); }
  void values(std::string_view name, std::vector<std::uint8_t>& v) override { in.dataset(place(name), v); }
  void values(std::string_view name, std::vector<std::int32_t>& v) override { in.dataset(place(name), v); }

  Hdf5Reader in;

 private:
  static std::string place(std::string_view name) { return fmt::format("{}{}", kState, name); }
};

std::string block_text(int schema, std::size_t size, std::uint64_t hash) {
  return fmt::format("{}schema {}\nbytes {}\nfnv1a64 {:016x}\n", kMagic, schema, size, hash);
}

/// Number after `key` in the text block.
std::optional<std::uint64_t> field(std::string_view text, std::string_view key, int base = 10) {
  const auto at = text.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  std::uint64_t v = 0;
  const char* begin = text.data() + at + key.size();
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), v, base);
  if (error != std::errc() || end == text.data() + text.size() || *end != '\n') return std::nullopt;
  return v;
}

/// Throws unless `bytes` is an undamaged checkpoint of this schema.
void verify(const std::string& label, std::span<const std::byte> bytes) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!all.starts_with(kMagic)) {
    const bool hdf5 = all.starts_with("\x89HDF\r\n\x1a\n");
    throw UsageError(fmt::format("{}: not a Meltray checkpoint ({})", label,
                                 bytes.empty() ? "empty file"
                                 : hdf5        ? "an HDF5 file of another kind"
                                               : "not an HDF5 file of ours, or its first bytes are damaged"));
  }
  const std::string_view head = all.substr(0, std::min(kBlock, all.size()));
  const auto schema = field(head, "\nschema ");
  const auto size = field(head, "\nbytes ");
  const auto hash = field(head, "\nfnv1a64 ", 16);
  if (schema && *schema != kCheckpointSchema)
    throw UsageError(fmt::format("{}: checkpoint schema {}; this program reads schema {}", label, *schema,
                                 kCheckpointSchema));
  if (all.size() < kBlock || (size && all.size() < kBlock + *size))
    throw UsageError(fmt::format("{}: truncated checkpoint: {} bytes, {} expected", label, all.size(),
                                 kBlock + size.value_or(0)));
  std::string expected;
  if (schema && size && hash) expected = block_text(kCheckpointSchema, *size, *hash);
  expected.resize(kBlock, '\0');
  if (head != expected || all.size() != kBlock + *size || fnv1a(bytes.subspan(kBlock)) != *hash)
    throw UsageError(fmt::format("{}: damaged checkpoint: its checksum does not match its content", label));
}

}  // namespace

void write_checkpoint(const fs::path& file, const CheckpointHeader& header,
                      const std::function<void(Archive&)>& save) {
  SavingArchive archive(header.expected_bytes);
  save(archive);
  archive.out().attribute("/", "schema_version", std::int64_t{kCheckpointSchema});
  archive.out().attribute("/", "units", std::string_view("SI"));
  archive.out().scalar("header/run_id", std::string_view(header.run_id));
  archive.out().scalar("header/version", std::string_view(header.version));
  archive.out().scalar("header/time_s", header.time);
  archive.out().scalar("header/step", header.step);
  archive.out().scalar("header/scheduled", std::int64_t{header.scheduled});
  const auto image = archive.out().image();
  std::string block = block_text(kCheckpointSchema, image.size(), fnv1a(image));
  block.resize(kBlock, '\0');
  replace_file(file, {std::as_bytes(std::span(block)), image});
}

Checkpoint open_checkpoint(const fs::path& file, const std::string& run_id) {
  const auto bytes = read_bytes(file);
  const std::string label = file.string();
  verify(label, bytes);
  auto archive = std::make_unique<LoadingArchive>(std::span(bytes).subspan(kBlock), label);
  Checkpoint checkpoint{file, {}, nullptr};
  auto& header = checkpoint.header;
  std::int64_t scheduled = 0;
  archive->in.scalar("header/run_id", header.run_id);
  archive->in.scalar("header/version", header.version);
  archive->in.scalar("header/time_s", header.time);
  archive->in.scalar("header/step", header.step);
  archive->in.scalar("header/scheduled", scheduled);
  header.scheduled = scheduled != 0;
  if (!run_id.empty() && header.run_id != run_id)
    throw UsageError(fmt::format("{}: checkpoint of another run (run id {}, this folder is {})", label,
                                 header.run_id, run_id));
  checkpoint.archive = std::move(archive);
  return checkpoint;
}

CheckpointSlots::CheckpointSlots(fs::path folder, std::string run_id)
    : folder_(std::move(folder)), run_id_(std::move(run_id)) {}

fs::path CheckpointSlots::file(int slot) const {
  return folder_ / (slot == 0 ? "checkpoint-a.h5" : "checkpoint-b.h5");
}

void CheckpointSlots::write(CheckpointHeader header, const std::function<void(Archive&)>& save) {
  header.run_id = run_id_;
  write_checkpoint(file(next_), header, save);
  if (header.scheduled) next_ = 1 - next_;
}

std::optional<Checkpoint> CheckpointSlots::newest(bool prefer_scheduled, std::vector<std::string>& warnings) {
  std::optional<Checkpoint> best;
  int best_slot = 0;
  std::vector<std::string> complaints;
  for (int slot = 0; slot < 2; ++slot) {
    if (!fs::exists(file(slot))) continue;
    try {
      Checkpoint c = open_checkpoint(file(slot), run_id_);
      const bool better = !best || (prefer_scheduled && c.header.scheduled != best->header.scheduled
                                        ? c.header.scheduled
                                        : c.header.time > best->header.time ||
                                              (c.header.time == best->header.time && c.header.scheduled));
      if (better) {
        best = std::move(c);
        best_slot = slot;
      }
    } catch (const UsageError& e) {
      complaints.emplace_back(e.what());
    } catch (const IoError& e) {  // the other slot may be readable
      complaints.emplace_back(e.what());
    }
  }
  if (!best && !complaints.empty()) {
    std::string all = "no usable checkpoint:";
    for (const auto& c : complaints) all += "\n  " + c;
    throw UsageError(all);
  }
  warnings.insert(warnings.end(), complaints.begin(), complaints.end());
  if (best) next_ = 1 - best_slot;
  return best;
}

}  // namespace meltray::observe
