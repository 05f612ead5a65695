#include "db/store/store.hpp"

#include "db/store/migrations.hpp"

namespace store {

Store::Store(std::unique_ptr<Connection> reader, std::unique_ptr<Connection> writer)
    : reader_(std::make_unique<Guarded>()), writer_(std::make_unique<Guarded>()) {
  reader_->connection = std::move(reader);
  writer_->connection = std::move(writer);
}

core::Result<Store> Store::open(const std::filesystem::path& path) {
  auto writer = open_sqlite(path, Access::write);
  if (!writer) return writer.error();
  if (auto done = migrate(**writer, migrations()); !done)
    return core::Error{done.error().code, path.string() + ": " + done.error().what};
  auto reader = open_sqlite(path, Access::read);
  if (!reader) return reader.error();
  return Store(std::move(*reader), std::move(*writer));
}

core::Result<void> Store::finish(Writing& tx, std::vector<Signals::Noted>& said) {
  if (auto noted = note_act(tx, audit_key_); !noted) return noted;
  if (tx.noted_.empty()) return {};
  said = std::move(tx.noted_);
  return signals_->committing(tx, said);
}

}  // namespace store
