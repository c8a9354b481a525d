# Two stages: the first builds, the second only runs. The RUN lines are those of tests/run.sh.
FROM debian:12-slim AS build
WORKDIR /src
COPY tests/install.sh tests/install.sh
RUN tests/install.sh build
COPY . .
RUN cmake --preset release -DBUILD_TESTING=OFF
RUN cmake --build --preset release --target lastflat
RUN DESTDIR=/installed cmake --install build/release

FROM debian:12-slim
COPY --from=build /src/tests/install.sh /tmp/install.sh
RUN /tmp/install.sh run && rm -rf /tmp/install.sh /var/lib/apt/lists/*
RUN useradd --system --uid 10001 --home-dir /data lastflat && install -d -o lastflat /data
COPY --from=build /installed/ /
USER lastflat
VOLUME /data
EXPOSE 8080
# Clients outside need an API key: docker exec CONTAINER lastflat keys add NAME
ENV LASTFLAT_LISTEN=0.0.0.0:8080 LASTFLAT_DATA=/data
HEALTHCHECK --interval=30s --timeout=3s --start-period=5s \
    CMD curl -fsS http://127.0.0.1:8080/healthz || exit 1
ENTRYPOINT ["lastflat"]
CMD ["serve"]
