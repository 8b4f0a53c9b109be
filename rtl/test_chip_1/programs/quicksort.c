// Sorts the words of the job by quicksort, the software that the accelerator is compared with.

struct job { // at 0x800
  int *words;
  int length;
};

extern const struct job job;

static void sort(int *first, int *last)
{
  while (last - first > 8) {
    int pivot = first[(last - first) / 2], *low = first, *high = last;
    while (low <= high) {
      while (*low < pivot)
        low++;
      while (pivot < *high)
        high--;
      if (low <= high) {
        int word = *low;
        *low++ = *high;
        *high-- = word;
      }
    }
    if (high - first < last - low) { // the smaller part by recursion: the stack stays small
      sort(first, high);
      first = low;
    } else {
      sort(low, last);
      last = high;
    }
  }
  for (int *next = first + 1; next <= last; next++) {
    int word = *next, *place = next;
    for (; place > first && place[-1] > word; place--)
      *place = place[-1];
    *place = word;
  }
}

int main(void)
{
  sort(job.words, job.words + job.length - 1);
  return 0;
}
