# docker build -t slipgym . && docker run --rm slipgym evaluate --policy hold_scratch --trials 20 --set engine=planar
FROM python:3.11-slim

RUN useradd --create-home slipgym
COPY --chown=slipgym . /home/slipgym/source
WORKDIR /home/slipgym/source
RUN pip install --no-cache-dir --constraint constraints.txt --editable '.[eval]'

USER slipgym
# The programs are compiled for the processor of this machine; another one compiles at its first step.
RUN slipgym warmup
ENTRYPOINT ["slipgym"]
CMD ["--help"]
