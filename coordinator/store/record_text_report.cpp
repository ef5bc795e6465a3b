// Text of records about measured errors and the shares of workers: for each kind a function that
// writes the fields, and one that reads them in the same order. Journals of older versions call the
// field `process` "renderer".

#include "coordinator/store/record_text_parts.h"

namespace bandsaw::coordinator {

void write_process(FieldWriter& out, WorkerProcessId process) { out.number("process", process); }

WorkerProcessId read_process(FieldReader& in) {
  return in.number(in.next_is("renderer") ? "renderer" : "process");
}

void write_error(FieldWriter& out, const record::ErrorMeasured& r) {
  const ErrorEstimate& estimate = r.point.estimate;
  out.number("job", r.job);
  out.number("samples", r.point.samples);
  out.real("elapsed_s", r.point.elapsed_s);
  out.real("cpu_s", r.point.cpu_s);
  out.real("mean", estimate.mean);
  out.real("rmse", estimate.rmse);
  out.real("relative_rmse", estimate.relative_rmse);
  out.real("margin", estimate.margin);
  out.real("relative_mse", estimate.relative_mse);
  out.real("median", estimate.median);
  out.real("percentile_95", estimate.percentile_95);
  out.real("percentile_99", estimate.percentile_99);
  out.real("worst_share", estimate.worst_share);
}

// Braced initialisers are evaluated in the order in which they are written, which is the order of
// the fields. Records of older versions lack the margin.

record::ErrorMeasured read_error(FieldReader& in) {
  return {.job = in.number("job"),
          .point = {.samples = in.number("samples"),
                    .elapsed_s = in.real("elapsed_s"),
                    .cpu_s = in.real("cpu_s"),
                    .estimate = {.mean = in.real("mean"),
                                 .rmse = in.real("rmse"),
                                 .relative_rmse = in.real("relative_rmse"),
                                 .margin = in.next_is("margin") ? in.real("margin") : 0,
                                 .relative_mse = in.real("relative_mse"),
                                 .median = in.real("median"),
                                 .percentile_95 = in.real("percentile_95"),
                                 .percentile_99 = in.real("percentile_99"),
                                 .worst_share = in.real("worst_share")}}};
}

void write_share(FieldWriter& out, const record::ShareCounted& r) {
  out.number("job", r.job);
  write_process(out, r.share.process);
  out.text("name", r.share.name);
  out.number("samples", r.share.samples);
  out.real("cpu_s", r.share.cpu_s);
}

record::ShareCounted read_share(FieldReader& in) {
  return {.job = in.number("job"),
          .share = {.process = read_process(in),
                    .name = in.text("name"),
                    .samples = in.number("samples"),
                    .cpu_s = in.real("cpu_s")}};
}

}  // namespace bandsaw::coordinator
