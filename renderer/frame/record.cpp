#include "renderer/frame/record.h"

#include "renderer/base/error.h"

namespace irad {

RecordMaker::RecordMaker(Context& context, std::string name, SubsystemName subsystem, uint64_t bytes)
    : context_(context), record_(context.device, std::move(name), subsystem, bytes) {}

uint64_t RecordMaker::of(const Buffer& buffer) {
  IRAD_CHECK(buffer.handle, "{}: the address of an empty buffer", record_.name);
  record_.place_->holds.push_back(buffer.place_);
  return buffer.place_->address;
}

uint64_t RecordMaker::own(uint64_t offset) const {
  IRAD_CHECK_OP(offset, <, record_.bytes);
  return record_.place_->address + offset;
}

Buffer RecordMaker::make(std::span<const std::byte> contents) {
  IRAD_CHECK(contents.size() == record_.bytes, "{}: {} bytes for a record of {}", record_.name, contents.size(),
             record_.bytes);
  upload(context_, record_, contents);
  return std::move(record_);
}

}  // namespace irad
