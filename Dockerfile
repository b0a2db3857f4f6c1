# The program in a container: docker build -t dynamic-icp . && docker run --rm -v "$PWD:/data" -w /data dynamic-icp run RECORDING --output OUT
FROM debian:bookworm AS build
COPY . /dynamic-icp
RUN apt-get update && apt-get install -y --no-install-recommends git && /dynamic-icp/scripts/packages.sh

FROM debian:bookworm-slim
RUN --mount=from=build,source=/dynamic-icp/build/packages,target=/packages \
    apt-get update && apt-get install -y --no-install-recommends /packages/dynamic-icp_*.deb && rm -rf /var/lib/apt/lists/*
ENTRYPOINT ["dynamic-icp"]
