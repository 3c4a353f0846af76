// softcell spu debug, driven by a client that speaks GDB's remote protocol.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_command.h"
#include "support/scratch_folder.h"

namespace softcell::tests {
namespace {

constexpr int kCounter = 0x81;  // the register

std::string debugged_file(const std::string& name) {
  return std::string(SOFTCELL_SPU_PROGRAMS "/") + name + ".O2.elf";
}

/// The command, and a connection to it.
class Debugged {
 public:
  explicit Debugged(const std::string& arguments) {
    const std::string line =
        std::string("exec timeout 60 ") + SOFTCELL_COMMAND + " spu debug " + arguments + " 2>&1";
    command_ = popen(line.c_str(), "r");
    std::array<char, 256> first{};
    unsigned port = 0;
    const bool has_port = std::fgets(first.data(), first.size(), command_) != nullptr &&
                          std::sscanf(first.data(), "a debugger may connect to port %u", &port) == 1;
    EXPECT_TRUE(has_port) << first.data();
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    const timeval patience{.tv_sec = 30, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Debugged() {
    if (socket_ >= 0) close(socket_);
    if (command_ != nullptr) pclose(command_);
  }
  Debugged(const Debugged&) = delete;
  Debugged& operator=(const Debugged&) = delete;

  void put(const std::string& bytes) {
    EXPECT_EQ(send(socket_, bytes.data(), bytes.size(), 0), ssize_t(bytes.size()));
  }
  void request(const std::string& contents) {
    unsigned sum = 0;
    for (const char c : contents) sum += static_cast<unsigned char>(c);
    std::array<char, 4> end{};
    std::snprintf(end.data(), end.size(), "#%02x", sum & 0xFF);
    put("$" + contents + end.data());
  }
  /// The next packet, acknowledgements aside.
  std::string reply() {
    std::string contents;
    bool is_inside = false;
    for (char c = 0; recv(socket_, &c, 1, 0) == 1;) {
      if (c == '$') {
        is_inside = true;
      } else if (c == '#') {
        std::array<char, 2> sum{};
        EXPECT_EQ(recv(socket_, sum.data(), sum.size(), MSG_WAITALL), 2);
        put("+");
        return contents;
      } else if (is_inside) {
        contents += c;
      }
    }
    ADD_FAILURE() << "no reply";
    return {};
  }
  std::string ask(const std::string& contents) {
    request(contents);
    return reply();
  }
  std::string reg(int number) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "p%x", number);
    return ask(text.data());
  }
  std::uint32_t counter() { return static_cast<std::uint32_t>(std::stoul(reg(kCounter), nullptr, 16)); }

  /// What the command printed after the first line, and its status, when it has ended.
  CommandResult end() {
    close(socket_);
    socket_ = -1;
    CommandResult result;
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), command_))
      result.output.append(buffer.data(), n);
    const int status = pclose(command_);
    command_ = nullptr;
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
  }

 private:
  std::FILE* command_ = nullptr;
  int socket_ = -1;
};

/// Where a function begins.
std::uint32_t address_of(const std::string& file, const std::string& function) {
  const ScratchFolder folder;
  EXPECT_EQ(run_softcell("spu disasm " + file + " --function " + function + " --json " + (folder / "d.json"))
                .status,
            0);
  std::ifstream stream(folder / "d.json");
  return nlohmann::json::parse(stream)["functions"][0]["instructions"][0]["address"];
}

std::string hex(std::uint32_t value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%x", value);
  return text.data();
}

TEST(SpuDebug, StandsBeforeTheFirstInstructionAndStepsBothWays) {
  Debugged spu(debugged_file("selfcheck"));
  EXPECT_NE(spu.ask("qSupported:multiprocess+").find("ReverseStep+;ReverseContinue+"), std::string::npos);
  EXPECT_EQ(spu.ask("?"), "T05thread:1;");
  const std::uint32_t entry = spu.counter();
  EXPECT_EQ(entry, 0x3D0u);
  EXPECT_EQ(spu.ask("s"), "T05thread:1;");
  EXPECT_EQ(spu.counter(), entry + 4);
  EXPECT_EQ(spu.ask("s"), "T05thread:1;");
  EXPECT_EQ(spu.counter(), entry + 8);
  EXPECT_EQ(spu.ask("bs"), "T05thread:1;");
  EXPECT_EQ(spu.counter(), entry + 4);
  EXPECT_EQ(spu.ask("bs"), "T05thread:1;");
  EXPECT_EQ(spu.counter(), entry);
  EXPECT_EQ(spu.ask("bs"), "T05thread:1;replaylog:begin;");
  EXPECT_EQ(spu.counter(), entry);
  EXPECT_EQ(spu.ask("k"), "OK");
  EXPECT_EQ(spu.end().status, 0);
}

TEST(SpuDebug, StopsAtBreakpointsAndGoesBackToThem) {
  const std::string file = debugged_file("selfcheck");
  const std::uint32_t function = address_of(file, "ackermann");
  Debugged spu(file);
  EXPECT_EQ(spu.ask("Z0," + hex(function) + ",4"), "OK");
  std::vector<std::string> arguments;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(spu.ask("c"), "T05thread:1;");
    EXPECT_EQ(spu.counter(), function);
    arguments.push_back(spu.reg(3) + spu.reg(4));
  }
  EXPECT_NE(arguments[0], arguments[1]);
  for (int i = 2; i >= 0; --i) {
    EXPECT_EQ(spu.ask("bc"), "T05thread:1;");
    EXPECT_EQ(spu.counter(), function);
    EXPECT_EQ(spu.reg(3) + spu.reg(4), arguments[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(spu.ask("bc"), "T05thread:1;replaylog:begin;");
  EXPECT_EQ(spu.ask("c"), "T05thread:1;");
  EXPECT_EQ(spu.reg(3) + spu.reg(4), arguments[0]);
  EXPECT_EQ(spu.ask("z0," + hex(function) + ",4"), "OK");
  EXPECT_EQ(spu.ask("c"), "W00");
  EXPECT_EQ(spu.ask("D"), "OK");
  const CommandResult end = spu.end();
  EXPECT_EQ(end.status, 0);
  EXPECT_NE(end.output.find("executed 27474 instructions"), std::string::npos) << end.output;
}

/// The start-up code ends its stack with a store of zeros to 0x3FFD0.
TEST(SpuDebug, StopsAtAccessesToMemory) {
  Debugged spu(debugged_file("selfcheck"));
  const std::uint32_t entry = spu.counter();
  EXPECT_EQ(spu.ask("M3ffd0,4:12345678"), "OK");
  EXPECT_EQ(spu.ask("m3ffd0,4"), "12345678");
  EXPECT_EQ(spu.ask("Z2,3ffd0,4"), "OK");
  EXPECT_EQ(spu.ask("c"), "T05thread:1;watch:3ffd0;");
  EXPECT_EQ(spu.counter(), entry + 12);
  EXPECT_EQ(spu.ask("m3ffd0,4"), "00000000");
  // Backwards, it stops where the old value still is: the one that was written here.
  EXPECT_EQ(spu.ask("bc"), "T05thread:1;watch:3ffd0;");
  EXPECT_EQ(spu.counter(), entry + 8);
  EXPECT_EQ(spu.ask("m3ffd0,4"), "12345678");
  EXPECT_EQ(spu.ask("m80,4").size(), 8u);
  EXPECT_EQ(spu.ask("k"), "OK");
}

TEST(SpuDebug, WritesRegistersAndMemoryAgainAfterGoingBack) {
  Debugged spu(debugged_file("selfcheck"));
  const std::string value = "00112233445566778899aabbccddeeff";
  EXPECT_EQ(spu.ask("s").substr(0, 3), "T05");
  EXPECT_EQ(spu.ask("P64=" + value), "OK");
  EXPECT_EQ(spu.reg(0x64), value);
  for (int i = 0; i < 3; ++i) spu.ask("s");
  EXPECT_EQ(spu.ask("bs"), "T05thread:1;");
  EXPECT_EQ(spu.reg(0x64), value);
  EXPECT_EQ(spu.ask("g").size(), 2u * (128 * 16 + 8));
  EXPECT_EQ(spu.ask("g").substr(0x64 * 32, 32), value);
  EXPECT_EQ(spu.ask("k"), "OK");
}

TEST(SpuDebug, HasAThreadForEachSpe) {
  const std::string file = debugged_file("selfcheck");
  const std::uint32_t function = address_of(file, "ackermann");
  Debugged spu(file + " --spes 3");
  EXPECT_EQ(spu.ask("qfThreadInfo"), "m1,2,3");
  EXPECT_EQ(spu.ask("qsThreadInfo"), "l");
  EXPECT_EQ(spu.ask("Z0," + hex(function) + ",4"), "OK");
  std::vector<int> hits(4);
  for (int i = 0; i < 12; ++i) {
    const std::string stop = spu.ask("c");
    ASSERT_EQ(stop.substr(0, 10), "T05thread:") << stop;
    ++hits[static_cast<std::size_t>(stop[10] - '0')];
  }
  EXPECT_EQ(spu.ask("Hg2"), "OK");
  EXPECT_EQ(spu.reg(0x80), "00000001");
  EXPECT_EQ(spu.ask("Hg4"), "E01");
  EXPECT_EQ(spu.ask("D"), "OK");
  const CommandResult end = spu.end();
  EXPECT_EQ(end.status, 0) << end.output;
  EXPECT_NE(end.output.find("SPE 2 executed 27474 instructions"), std::string::npos) << end.output;
}

/// The SPEs take turns, so the second one begins after the first one has ended: selfcheck has no channel operation.
TEST(SpuDebug, StepsAnSpeThatHasNotBegunAndShowsWhichHaveEnded) {
  Debugged spu(debugged_file("selfcheck") + " --spes 2");
  const std::string first = spu.ask("m3d0,10");
  EXPECT_EQ(spu.ask("Hg2"), "OK");
  const std::uint32_t entry = spu.counter();
  EXPECT_EQ(entry, 0x3D0u);
  EXPECT_EQ(spu.ask("m3d0,10"), first) << "the code lies there before the first turn";
  EXPECT_EQ(spu.ask("m0,4"), "00000000");
  EXPECT_EQ(spu.ask("s"), "T05thread:2;");
  EXPECT_EQ(spu.counter(), entry + 4);
  EXPECT_EQ(spu.ask("qfThreadInfo"), "m2");
  EXPECT_EQ(spu.ask("T1"), "E01");
  EXPECT_EQ(spu.ask("T2"), "OK");
  EXPECT_EQ(spu.ask("Hg1"), "OK");
  EXPECT_EQ(spu.ask("s").substr(0, 1), "E") << "it has ended";
  EXPECT_EQ(spu.ask("Hg2"), "OK");
  EXPECT_EQ(spu.ask("bs").substr(0, 3), "T05");
  EXPECT_EQ(spu.ask("c"), "W00");
}

/// A step over the end of an SPE stops where another one goes on.
TEST(SpuDebug, StopsAtTheNextSpeWhenOneHasEnded) {
  Debugged spu(debugged_file("selfcheck") + " --spes 2");
  EXPECT_EQ(spu.ask("Z0,410,4"), "OK");  // the start-up code's stop
  EXPECT_EQ(spu.ask("c"), "T05thread:1;");
  EXPECT_EQ(spu.ask("s"), "T05thread:2;");
  EXPECT_EQ(spu.counter(), 0x3D0u);
  EXPECT_EQ(spu.ask("c"), "T05thread:2;");
  EXPECT_EQ(spu.ask("s"), "W00");
}

/// The program fails as it waits for a mailbox that nobody fills. The debugger can read its registers there; when it goes on, it ends.
TEST(SpuDebug, StandsWhereItFailsBeforeItEnds) {
  Debugged spu(debugged_file("mailbox_echo"));
  std::string stop = spu.ask("c"), said;
  for (; stop.starts_with("O"); stop = spu.reply()) said += stop;
  EXPECT_EQ(stop, "T06thread:1;");
  EXPECT_NE(said, "") << "a sentence says why";
  const std::string place = spu.ask("p81"), registers = spu.ask("g");
  EXPECT_NE(place, "00000000");
  EXPECT_EQ(spu.ask("bs"), "T05thread:1;");
  EXPECT_NE(spu.ask("p81"), place);
  EXPECT_EQ(spu.ask("s"), "T05thread:1;");
  EXPECT_EQ(spu.ask("p81"), place);
  EXPECT_EQ(spu.ask("g"), registers);
  EXPECT_EQ(spu.ask("c"), "X06");
}

TEST(SpuDebug, IsInterrupted) {
  // Without mail, it would wait for ever; with breakpoints nowhere, a loop runs until byte 3 comes.
  Debugged spu(debugged_file("selfcheck"));
  spu.request("c");
  spu.put("\x03");
  const std::string stop = spu.reply();
  EXPECT_TRUE(stop == "T02thread:1;" || stop == "W00") << stop;  // it takes milliseconds only
  EXPECT_EQ(spu.ask("k"), "OK");
}

TEST(SpuDebug, AnswersWhatItDoesNotKnowAndRefusesWhatIsWrong) {
  Debugged spu(debugged_file("selfcheck"));
  EXPECT_EQ(spu.ask("vMustReplyEmpty"), "");
  EXPECT_EQ(spu.ask("m12"), "E01");
  EXPECT_EQ(spu.ask("m40000,4"), "E01");
  EXPECT_EQ(spu.ask("mffffffffffff,4"), "E01");
  EXPECT_EQ(spu.ask("M80,4:1234"), "E01");
  EXPECT_EQ(spu.ask("p82"), "E01");
  EXPECT_EQ(spu.ask("P81=00000080"), "E02");
  EXPECT_EQ(spu.ask("c100"), "E02");
  EXPECT_EQ(spu.ask("Z9,80,4"), "");
  EXPECT_EQ(spu.ask("m3fffe,100").size(), 4u);
  const std::string description = spu.ask("qXfer:features:read:target.xml:0,3fff");
  EXPECT_NE(description.find("name=\"r127\" bitsize=\"128\""), std::string::npos) << description;
  spu.put("$?#00");  // a wrong sum: it asks for the packet again, and goes on
  EXPECT_EQ(spu.ask("?"), "T05thread:1;");
  EXPECT_EQ(spu.end().status, 0);  // the connection breaks
}

TEST(SpuDebug, IsForProgramsOfTheSpu) {
  const CommandResult host = run_softcell(std::string("spu debug ") + SOFTCELL_SAXPY);
  EXPECT_EQ(host.status, 1);
  EXPECT_NE(host.output.find("this image is built for the host"), std::string::npos) << host.output;
  EXPECT_EQ(run_softcell("spu debug --port 70000 " + debugged_file("selfcheck")).status, 2);
}

}  // namespace
}  // namespace softcell::tests
