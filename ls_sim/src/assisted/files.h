#pragma once
// The files that programs on SPEs have open: streams by handle, descriptors by number.

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "softcell/ls_sim/host_calls.h"

namespace softcell::ls_sim::assisted {

/// Handles of the three streams that are open from the beginning. [newlib, c99ppe.h] documented
enum StandardStream : std::uint32_t { kStandardInput = 1, kStandardOutput = 2, kStandardError = 3 };

/// A stream stays open as long as somebody uses it.
using Stream = std::shared_ptr<std::FILE>;

/// All functions that fail set errno. Any thread.
class Files {
 public:
  virtual ~Files() = default;

  /// @return  -1, or a descriptor of the host
  virtual int open(const std::string& path, int flags, unsigned int mode) = 0;
  virtual int remove(const std::string& path) = 0;
  virtual int rename(const std::string& from, const std::string& to) = 0;
  /// The program's number of a descriptor; -1: there are too many, and the descriptor is closed.
  virtual int add_descriptor(int descriptor) = 0;
  /// The host's descriptor, -1 for none.
  virtual int descriptor_of(std::uint32_t number) = 0;
  virtual int close_descriptor(std::uint32_t number) = 0;
  /// Whether a run is to end, so that nothing may wait any longer; a kernel for the host is sent a signal.
  virtual bool is_interrupted() const { return false; }

  /// @return  a handle; 0 is an error, and the stream is closed
  std::uint32_t add_stream(std::FILE* stream);
  /// @return  null for a handle that stands for no stream
  Stream stream(std::uint32_t handle);
  int close_stream(std::uint32_t handle);
  /// The handle stands for the opened stream from now on. @return  whether it does; if not, the opened one is closed
  bool replace_stream(std::uint32_t handle, std::FILE* opened);

 protected:
  /// The stream of a StandardStream.
  virtual Stream standard_stream(std::uint32_t handle) = 0;
  virtual bool replace_standard_stream(std::uint32_t handle, const Stream& opened) = 0;
  void close_streams();

 private:
  std::mutex mutex_;
  std::vector<Stream> streams_;  ///< by handle less kFirstHandle; null is free
};

/// All files that this process may open, for kernels built for the host. Numbers of descriptors are those of the process.
Files& files_of_process();

/// The files in the folder of HostCalls, and its three streams, for one program that is interpreted.
class FilesInFolder final : public Files {
 public:
  /// @param calls  outlives this.
  /// @param interrupted  outlives this; true: the run is to end
  FilesInFolder(const HostCalls& calls, const std::atomic<bool>& interrupted);
  ~FilesInFolder() override;

  int open(const std::string& path, int flags, unsigned int mode) override;
  int remove(const std::string& path) override;
  int rename(const std::string& from, const std::string& to) override;
  int add_descriptor(int descriptor) override;
  int descriptor_of(std::uint32_t number) override;
  int close_descriptor(std::uint32_t number) override;
  bool is_interrupted() const override { return interrupted_.load(std::memory_order_relaxed); }
  /// Waits for what a program reads. @return  as HostCalls::standard_input; 0 too when the run is to end
  std::size_t read_input(std::span<char> to) const;
  /// Closes all files, as the end of a process does.
  void close_all();

 protected:
  Stream standard_stream(std::uint32_t handle) override { return standard(handle); }
  bool replace_standard_stream(std::uint32_t handle, const Stream& opened) override;

 private:
  Stream& standard(std::uint32_t handle);

  const HostCalls& calls_;
  const std::atomic<bool>& interrupted_;
  Stream input_, output_, error_;
  std::vector<int> descriptors_;  ///< by number less kFirstDescriptor; -1 is free
};

}  // namespace softcell::ls_sim::assisted
