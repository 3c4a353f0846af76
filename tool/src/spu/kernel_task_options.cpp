#include "kernel_task_options.h"

#include "command_line/shared_options.h"
#include "command_line/shell_words.h"
#include "softcell/dma/addresses.h"
#include "verb/deadline.h"

namespace softcell::tool {

void KernelTaskOptions::add_to(CLI::App& verb) {
  verb.add_option(
          "IMAGE", image_,
          "A kernel: its .spu.elf file, the name of one of softcell's own, or a program built for the SPU")
      ->required()
      ->type_name("KERNEL");
  verb.add_flag("--checked", checked_,
                "Use the checked image, IMAGE's .checked.spu.elf: findings name file and line");
  verb.add_option(
          "--engine", engine_,
          "What runs it: native for images built for the host, interpreter for programs built for the SPU "
          "(default: what the image needs)")
      ->type_name("native|interpreter");
  verb.add_option("--entry", entry_,
                  "Who starts a program built for the SPU: libspe2 (default), or thread-group, where the "
                  "words of --arg, "
                  "at most four, are main's own arguments")
      ->type_name("libspe2|thread-group");
  accept_whole_number(
      verb.add_option("--spes", spes_,
                      "SPEs that run it, 1 to 6 (default: 1); main's first parameter is the SPE's number"),
      1, dma::kSpeCount)
      ->type_name("SPES");
  // One buffer after each option, because the next word may be IMAGE.
  verb.add_option("--in", in_, "A buffer that the kernel reads, filled from the file")
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("NAME=FILE");
  verb.add_option("--out", out_, "A buffer of zeros that becomes the file when the run succeeds")
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("NAME=FILE:SIZE");
  verb.add_option("--inout", inout_, "A buffer filled from the file, which is replaced when the run succeeds")
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("NAME=FILE");
  verb.add_option("--arg", arguments_,
                  "Words of 64 bits: integers, f32:VALUE, @NAME (a buffer's address), #NAME (its bytes); "
                  "argp is their address, envp their number")
      ->type_name("WORD");
  verb.add_option("--in-mbox", in_mbox_, "Values waiting in each inbound mailbox, at most four")
      ->type_name("VALUE");
  verb.add_option("--deadline", deadline_,
                  "Seconds after which a run is stopped with a fault, 0.001 to 86400 (default: 10)")
      ->type_name("SECONDS");
}

KernelTask KernelTaskOptions::task() const {
  KernelTask task{.image = image_,
                  .checked = checked_,
                  .machine = parse_engine(engine_),
                  .entry_state = parse_entry(entry_),
                  .spes = spes_};
  for (const std::string& text : in_) task.buffers.push_back(parse_file_buffer(BufferSpec::kIn, text));
  for (const std::string& text : inout_) task.buffers.push_back(parse_file_buffer(BufferSpec::kInOut, text));
  for (const std::string& text : out_) task.buffers.push_back(parse_out_buffer(text));
  for (const std::string& text : arguments_) task.arguments.push_back(parse_argument(text));
  for (const std::string& text : in_mbox_) task.in_mbox.push_back(parse_mbox_value(text));
  if (!deadline_.empty()) task.deadline = parse_deadline(deadline_);
  check(task);
  return task;
}

std::string KernelTaskOptions::text() const {
  std::string text = quoted_for_shell(image_);
  if (checked_) text += " --checked";
  if (!engine_.empty()) text += " --engine " + engine_;
  if (entry_ != "libspe2") text += " --entry " + entry_;
  if (spes_ != 1) text += " --spes " + std::to_string(spes_);
  const auto add = [&](const std::string& option, const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      // A value that looks like an option is only taken after '='.
      const bool separate = !value.starts_with('-');
      text += " " + option + (separate ? " " : "=") + quoted_for_shell(value);
    }
  };
  add("--in", in_);
  add("--inout", inout_);
  add("--out", out_);
  add("--arg", arguments_);
  add("--in-mbox", in_mbox_);
  if (!deadline_.empty()) text += " --deadline " + deadline_;
  return text;
}

}  // namespace softcell::tool
