# Of a program in C: the global pointer, the stack below the job, main, and the end
.option norelax
la gp, __global_pointer$
la sp, job
call main
ebreak
