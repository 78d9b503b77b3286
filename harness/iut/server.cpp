#include "harness/iut/server.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "harness/kernel/error.hpp"

namespace fieldproof::iut {
namespace {

[[noreturn]] void refuse_bench(const std::string& why) {
  throw kernel::Error(kernel::ErrorKind::implementation,
                      fmt::format("what comes from the bench is no message: {}", why));
}

// Blocking, both ways: a server has nothing else to do.
class MessagePipe {
 public:
  MessagePipe(int input, int output) : input_(input), output_(output) {}

  // Empty at the end of the stream between two messages.
  std::span<const std::uint8_t> receive() {
    if (!wait_for(kMessageHead)) {
      if (begin_ != end_) refuse_bench("it ends in the middle");
      return {};
    }
    std::size_t length = 0;
    for (std::size_t n = 0; n < kMessageHead; ++n) length |= std::size_t{buffer_[begin_ + n]} << (8 * n);
    if (length == 0 || length > kLongestMessage) refuse_bench(fmt::format("a length of {} octets", length));
    if (!wait_for(kMessageHead + length)) refuse_bench("it ends in the middle");
    const auto message = std::span<const std::uint8_t>(buffer_).subspan(begin_ + kMessageHead, length);
    begin_ += kMessageHead + length;
    return message;
  }

  bool has_more() const { return begin_ != end_; }

  void send(std::span<const std::uint8_t> message) {
    while (!message.empty()) {
      const ssize_t sent = ::write(output_, message.data(), message.size());
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) refuse_bench("it has gone");
      message = message.subspan(static_cast<std::size_t>(sent));
    }
  }

 private:
  bool wait_for(std::size_t octets) {
    constexpr std::size_t kReadAhead = 64U * 1024;
    while (end_ - begin_ < octets) {
      if (begin_ == end_) begin_ = end_ = 0;
      if (buffer_.size() - end_ < kReadAhead) buffer_.resize(end_ + kReadAhead);
      const ssize_t count = ::read(input_, buffer_.data() + end_, buffer_.size() - end_);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      end_ += static_cast<std::size_t>(count);
    }
    return true;
  }

  int input_;
  int output_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

class Server final : private Bench {
 public:
  Server(int input, int output, const RoleName& served, const MakeDevice& make_device,
         std::string_view own_name, const Idle& idle)
      : input_(input),
        pipe_(input, output),
        served_(served),
        make_device_(make_device),
        own_name_(own_name),
        idle_(idle) {}

  void run() {
    while (true) {
      if (idle_ && !pipe_.has_more()) idle_(input_);
      const auto message = pipe_.receive();
      if (message.empty()) return;
      try {
        MessageReader reader(message);
        answer(reader);
      } catch (const MessageError& error) {
        refuse_bench(error.what());
      }
    }
  }

 private:
  void answer(MessageReader& reader) {
    if (reader.type() == MessageType::hello) return hello(reader);
    if (reader.type() == MessageType::echo) {
      const auto octets = reader.rest();
      writer_.begin(MessageType::echoed).octets(octets);
      return pipe_.send(writer_.finish());
    }
    if (device_ == nullptr) throw MessageError("the first one is 'hello'");
    if (reader.type() == MessageType::case_begin) {
      const CaseBegin begin = read_case_begin(reader);
      is_in_case_ = false;
      // A station may take part in the cases of another role, as a slave does in those of a network.
      const bool is_meant = begin.id.starts_with(role_.protocol + "/");
      if (!is_meant || !device_->begin(begin, *this)) {
        writer_.begin(MessageType::unsupported);
        return pipe_.send(writer_.finish());
      }
      is_in_case_ = true;
    } else {
      if (!is_in_case_)
        throw MessageError(fmt::format("'{}' is for a case that has begun", name(reader.type())));
      pass_on(reader);
    }
    writer_.begin(MessageType::done).time(device_->next_time());
    pipe_.send(writer_.finish());
  }

  void hello(MessageReader& reader) {
    reader.u16();  // the bench refuses a version that is not its own
    role_.protocol = reader.text();
    role_.role = reader.text();
    reader.finish();
    const bool is_asked_which = role_ == RoleName{};
    device_ = make_device_(is_asked_which ? served_ : role_);
    if (device_ == nullptr) {
      writer_.begin(MessageType::unsupported);
      return pipe_.send(writer_.finish());
    }
    pipe_.send(write_capabilities(writer_, {kMessageVersion,
                                            static_cast<std::uint8_t>(device_->unit_kind()),
                                            std::string(own_name_),
                                            {is_asked_which ? served_ : role_},
                                            device_->capabilities().senses_activity}));
  }

  void pass_on(MessageReader& reader) {
    switch (reader.type()) {
      case MessageType::power: {
        const bool is_on = reader.u8() != 0;
        return device_->set_power(is_on, reader.time());
      }
      case MessageType::receive_characters: {
        const ReceivedCharacters received = read_reception(reader);
        return device_->receive(received.port, received.characters, received.now);
      }
      case MessageType::receive_levels: {
        const unsigned port = read_levels(reader, wave_);
        return device_->receive(port, wave_);
      }
      case MessageType::activity: {
        const LineActivity activity = read_activity(reader);
        return device_->on_activity(activity.port, activity.begins, activity.now);
      }
      case MessageType::on_time:
        return device_->on_time(reader.time());
      case MessageType::case_end:
        is_in_case_ = false;
        return device_->end();
      default:
        throw MessageError(fmt::format("'{}' is nothing that a bench says here", name(reader.type())));
    }
  }

  void set_driver(unsigned port, bool is_on, kernel::Time at) override {
    pipe_.send(write_driver(writer_, {port, is_on, at}));
  }
  void send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) override {
    pipe_.send(write_characters(writer_, port, start, characters));
  }
  void transmit(unsigned port, line::Waveform& wave) override {
    pipe_.send(write_levels(writer_, MessageType::transmit_levels, port, wave));
    wave.levels.clear();
  }
  void write(Item item, std::uint64_t value, kernel::Time when) override {
    writer_.begin(MessageType::write).u16(item).u64(value).time(when);
    pipe_.send(writer_.finish());
  }
  std::uint64_t read(Item item, kernel::Time when) override {
    writer_.begin(MessageType::read).u16(item).time(when);
    pipe_.send(writer_.finish());
    const auto message = pipe_.receive();
    if (message.empty()) refuse_bench("it has gone");
    MessageReader reader(message);
    if (reader.type() != MessageType::value) throw MessageError("a 'value' is expected");
    return reader.u64();
  }

  int input_;
  MessagePipe pipe_;
  const RoleName& served_;
  const MakeDevice& make_device_;
  std::string_view own_name_;
  const Idle& idle_;
  RoleName role_;
  std::unique_ptr<Device> device_;
  bool is_in_case_ = false;
  MessageWriter writer_;
  line::Waveform wave_;
};

}  // namespace

void serve(int input, int output, const RoleName& served, const MakeDevice& make_device,
           std::string_view own_name, const Idle& idle) {
  Server(input, output, served, make_device, own_name, idle).run();
}

}  // namespace fieldproof::iut
